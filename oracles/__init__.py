"""The judges: what an image should be, how far it may be off, and what is wrong with it."""
