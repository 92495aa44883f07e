"""Turns a results folder of oitlab into a table, plots and a report.

The modules, in the order in which the data passes through them: `checks`, `packs` and `cells` read
the files, `statistics` compares the cells of a group, `sections` keeps apart what must not be
compared, `scatter`, `sweeps` and `bars` draw what `plots` asks for, `table`, `report` and `page`
write it down. `diff` compares two folders, `paper` sets cells beside published figures.
"""
