"""Translator from a tool-independent `case.yaml` of the Modelica cases to a Driveline, and the comparison.

network.py   flanges joined to rigid nodes
initial.py   positions and speeds of the nodes at the start
signals.py   signals over time
elements.py  one entry per element type
model.py     the whole: case -> Driveline and the function of each output
compare.py   against reference.csv
"""
