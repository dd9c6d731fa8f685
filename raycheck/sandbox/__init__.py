"""Running strangers' code so that it reaches nothing but what it is given: bubblewrap, and limits on what it uses."""

from raycheck.sandbox.jail import Jail
from raycheck.sandbox.limits import Limits
from raycheck.sandbox.room import OPEN, Room

__all__ = ["OPEN", "Jail", "Limits", "Room"]
