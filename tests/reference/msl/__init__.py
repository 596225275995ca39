"""Translator from a tool-independent `case.yaml` of the Modelica cases to a Driveline, and the comparison.

network.py   flanges joined to rigid nodes
initial.py   positions and speeds of the nodes at the start
pieces.py    signals as pieces: sums, products, integrals, filters
signals.py   signals of a case, and as clutchwork signals
elements.py  one entry per element type
model.py     the whole: case -> Driveline and the function of each output
compare.py   against reference.csv
"""
