"""What computes: solve(), diagnose(), sweep(), with bars of their progress."""
