"""From a results folder to sections, and from those to drawn charts."""

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from oitlab_analysis.compare.sections import add_comparisons, make_sections
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.draw.style import STYLE
from oitlab_analysis.read.cells import collect


def sections_of(*folders):
    cells = collect(*folders).cells
    return make_sections(cells, add_comparisons(as_table(cells), cells))


def section_of(*folders):
    return sections_of(*folders)[0]


def drawn(draw, *arguments):
    """The figure, laid out and rendered in the style of the charts."""
    with matplotlib.rc_context(STYLE):
        figure = draw(*arguments)
        FigureCanvasAgg(figure).draw()
    return figure
