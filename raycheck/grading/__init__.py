"""Grading a class: submissions in, scores and reports out."""
