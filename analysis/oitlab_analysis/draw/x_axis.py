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
MOST_TICKS = 6


class XAxis:
    """Where the values of x stand. `values` are those of all panels, which have the same axis."""

    def __init__(self, values: list, is_number: bool):
        self._places = in_order(values)
        self._numbers = [place for place in self._places if not isinstance(place, Special)]
        self._specials = self._places[len(self._numbers):]
        few = bool(self._specials) and len(self._numbers) < 2
        self._even = not is_number or few or _uneven(self._numbers)
        self._log = not self._even and self._numbers[0] > 0 and self._numbers[-1] / self._numbers[0] > LOG_ABOVE
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
        elif not self._specials:
            axes.xaxis.set_major_formatter(lambda value, _: linear_label(value))
            axes.xaxis.get_major_locator().set_params(integer=self._whole())
        if not self._specials:
            return
        if not self._even:
            self._name_specials(axes)
        edge = self.at(self._specials[0]) - 0.5 if self._even else self._beyond(0.5)
        axes.axvline(edge, color="#777777", linewidth=0.7, linestyle=":", zorder=0.5)

    def _whole(self) -> bool:
        return all(float(number).is_integer() for number in self._numbers)

    def _name_specials(self, axes: Axes) -> None:
        """Ticks for the numbers as without special values, then one with the word of each of these."""
        first, last = self._numbers[0], self._numbers[-1]
        if self._log:
            ticks = [tick for tick in log_ticks(first / 1.1, last * 1.1, MOST_TICKS)]
        else:
            ticks = MaxNLocator(MOST_TICKS, integer=self._whole()).tick_values(first, last)
            ticks = [tick for tick in ticks if first <= tick <= last]
        words = {self.at(special): special.word for special in self._specials}
        write = plain if self._log else linear_label
        axes.xaxis.set_major_locator(FixedLocator([*ticks, *words]))
        axes.xaxis.set_major_formatter(lambda value, _: words.get(value) or write(value))


def _uneven(numbers: list) -> bool:
    """Few values, most of them crowded: 0, 0.9, 0.99, 0.999. Each gets the same room."""
    if len(numbers) < 3 or len(numbers) > 8:
        return False
    steps = numpy.diff(numbers)
    return steps.max() > 8 * numpy.median(steps)


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
