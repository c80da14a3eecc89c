"""solve(), diagnose() and sweep(), with progress bars."""
