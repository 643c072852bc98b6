"""A coach on a bridge of 16 m for 20 steps, with three recorded nodes of the deck."""

SCENE = """
[train]
vehicle = "manchester-coach"
speed_kmh = 200
start = 2.0
[contact]
mode = "online"
creep_law = "polach"
[track]
length_before = 30
length_after = 10
[[bridge]]
length = 16
elements = 8
[structure]
report = [4.0, 8.0, 12.0]
[integration]
duration = 0.02
time_step = 1e-3
"""
