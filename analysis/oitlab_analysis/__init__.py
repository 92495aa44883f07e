"""Turns cells that `oitlab run` wrote into tables, plots, reports and comparisons.

Each folder uses those before it, and none after it:

read      files into checked cells
compare   cells into one tidy table; ratios, verdicts, labels, sections, what changed between two runs
draw      the charts
write     reports as a page, Markdown, CSV and text
paper     the papers' tables and figures, published beside measured

`formats` says how numbers are written; all use it.
"""
