"""Where methods fail: strata of inputs, exact truth for each, error maps and failure frontiers."""
