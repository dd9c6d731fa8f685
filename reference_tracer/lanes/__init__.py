"""The same formulas on arrays: one lane a ray, one generation at a time."""

from reference_tracer.lanes import numpy_backend as numpy_backend  # NumPy arrays are numbers from here on
