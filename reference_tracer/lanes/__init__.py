"""The same formulas on arrays: one lane a ray, one generation at a time."""
