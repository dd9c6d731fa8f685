"""The lecture's formulas, one function each, on a generic number.

No `if` on a number, no `**`, no division by a literal, no builtin min, max or
abs: these rules keep one body valid for floats, lanes, balls and exact numbers.
L11 is "Computer Graphics and Programming, Lecture 11, Ray Tracing".
"""
