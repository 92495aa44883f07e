"""Turns a results folder of oitlab into a table, plots and a report.

The modules, in the order in which the data passes through them: `cells` reads the JSON files,
`statistics` compares the cells of a group, `sections` keeps apart what must not be compared,
`plots` and `images` make the pictures, `table` and `report` write them down.
"""
