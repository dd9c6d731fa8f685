"""Speed against accuracy: every method in every arithmetic, timed side by side and judged by exact truth."""
