"""Libraries of motions in the formats of programs that train policies (docs/trainers.md)."""
