"""The papers' tables and figures, published beside measured.

`published` reads what the papers print, `measured` finds the cells that answer to it, `lucidraster`,
`methods` and `bma_tables` put both into tables with the help of `common`, `agreement` says where they
agree, `paired_table` writes them, `bma_figures` draws, and `make` does it all.
"""
