"""retarget(): plans that follow references of base and joints (docs/retarget.md)."""

from .run import Deviation, Retargeted, retarget

__all__ = ["Deviation", "Retargeted", "retarget"]
