"""Peers: other people's renderers on our scenes.

A reference that agrees only with itself proves little. Mitsuba 3 and POV-Ray each run in a process of their
own, since an error inside them must cost a verdict and not the suite. Nothing here imports Mitsuba
but the modules `mitsuba_*`, which only that process loads.
"""
