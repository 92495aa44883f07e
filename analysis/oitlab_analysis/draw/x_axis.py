"""The x axis of a curve: numbers on a scale, or a place for each value; special values at its end."""

from __future__ import annotations

import numpy
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, MaxNLocator

from .. import formats
from ..compare.quantities import in_order
from ..compare.special_values import Special
from .layout import characters, linear_label, log_axis, log_ticks, plain
from .style import PAGE

LOG_ABOVE = 20  # span of values from which on the axis is logarithmic
APART = 0.15  # of the length of the scale: how far beyond it a special value stands
MARGIN = 0.05  # of the length of the axis, on both sides
MOST_TICKS = 6
MOST_NAMED = 8  # numbers with a tick each
CROWDED = 0.07  # of the length of the scale: numbers that are closer have no room for their ticks


class XAxis:
    """Where the values of x stand. `values` are those of all panels, which have the same axis."""

    def __init__(self, values: list, is_number: bool):
        self._places = in_order(values)
        self._numbers = [place for place in self._places if not isinstance(place, Special)]
        self._specials = self._places[len(self._numbers):]
        few = bool(self._specials) and len(self._numbers) < 2
        self._log = is_number and not few and self._numbers[0] > 0 and \
            self._numbers[-1] / self._numbers[0] > LOG_ABOVE
        self._even = not self._log and (not is_number or few or _uneven(self._numbers))
        if self._even:
            at = range(len(self._places))
        else:
            at = [*self._numbers, *(self._beyond(number + 1) for number in range(len(self._specials)))]
        self._at = dict(zip(self._places, at))

    def at(self, value) -> float:
        """The coordinate of one of the values."""
        return self._at[value]

    def _beyond(self, steps: float) -> float:
        """Right of the numbers by so many steps."""
        first, last = self._numbers[0], self._numbers[-1]
        return last * (last / first) ** (APART * steps) if self._log else last + (last - first) * APART * steps

    def apply(self, axes: Axes) -> None:
        """Sets scale, limits and ticks, and draws a line between the numbers and the special values."""
        if self._even:
            _name_places(axes, self._places)
        elif self._log:
            log_axis(axes, "x", self._numbers[0] / 1.1, self._beyond(len(self._specials)) * 1.1, MOST_TICKS)
        else:
            first, last = self._numbers[0], self._beyond(len(self._specials))
            margin = MARGIN * (last - first) or 0.5
            axes.set_xlim(first - margin, last + margin)
            axes.xaxis.set_major_locator(FixedLocator(self._ticks()))
            axes.xaxis.set_major_formatter(lambda value, _: linear_label(value))
        if not self._specials:
            return
        if not self._even:
            self._name_specials(axes)
        edge = self.at(self._specials[0]) - 0.5 if self._even else self._beyond(0.5)
        axes.axvline(edge, color="#777777", linewidth=0.7, linestyle=":", zorder=0.5)

    def _ticks(self) -> list[float]:
        """Where the numbers have ticks: at each of them if they are few, else at round places."""
        first, last = self._numbers[0], self._numbers[-1]
        if self._log:
            return log_ticks(first / 1.1, last * 1.1, MOST_TICKS)
        if len(self._numbers) <= MOST_NAMED and min(numpy.diff(self._numbers), default=1) >= CROWDED * (last - first):
            return self._numbers
        whole = all(float(number).is_integer() for number in self._numbers)
        ticks = MaxNLocator(MOST_TICKS, integer=whole).tick_values(first, last)
        return [tick for tick in ticks if first <= tick <= last]

    def _name_specials(self, axes: Axes) -> None:
        """Ticks for the numbers, then one with the word of each special value."""
        words = {self.at(special): special.word for special in self._specials}
        write = plain if self._log else linear_label
        axes.xaxis.set_major_locator(FixedLocator([*self._ticks(), *words]))
        axes.xaxis.set_major_formatter(lambda value, _: words.get(value) or write(value))


def _uneven(numbers: list) -> bool:
    """Few values, most of them crowded at the end: 0.8, 0.9, 0.99, 0.998. Each gets the same room."""
    if len(numbers) < 3 or len(numbers) > 8:
        return False
    steps = numpy.diff(numbers)
    return steps.max() > 4 * numpy.median(steps)


def _name_places(axes: Axes, places: list) -> None:
    """Ticks at even places: every name that finds room, numbers with as few digits as tell them apart."""
    names = [formats.parameter(place) for place in places]
    for digits in range(2, 7):
        short = [f"{place:.{digits}g}" if formats.is_number(place) else str(place) for place in places]
        if len(set(short)) == len(places):
            names = short
            break
    size = 6
    room = characters(axes.get_position().width * PAGE, size)
    step = -(-sum(len(name) + 1 for name in names) // room)
    shown = range(0, len(places), step)
    if isinstance(places[-1], Special) and len(places) - 1 not in shown:  # its word is never left out
        shown = [place for place in shown if place < len(places) - step] + [len(places) - 1]
    axes.set_xticks(list(shown), [names[place] for place in shown], size=size)
    axes.set_xlim(-0.4, len(places) - 0.6)
