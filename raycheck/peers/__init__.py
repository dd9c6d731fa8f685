"""What each peer is known to do otherwise, shipped with its reason."""
