"""The lecture's tracer: formulas once, numbers many; plain recursion and wavefront."""
