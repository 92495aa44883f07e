"""Memory of the method alone, a pixel and a fragment."""

from oitlab_analysis.compare.memory import own_memory


def test_own_memory_is_told_by_pixel_and_by_fragment():
    cell = {"size": [64, 36], "counters": {"fragments": 1000},
            "memory_bytes": {"method": 64 * 36 * 24, "total": 10**9}}
    own = own_memory(cell)
    assert own["memory_method_bytes"] == 64 * 36 * 24
    assert own["bytes_per_pixel"] == 24
    assert own["bytes_per_fragment"] == 64 * 36 * 24 / 1000


def test_what_is_not_known_stays_empty():
    assert set(own_memory({"size": [64, 36]}).values()) == {None}
    no_count = own_memory({"size": [64, 36], "counters": {}, "memory_bytes": {"method": 2304}})
    assert no_count["bytes_per_pixel"] == 1 and no_count["bytes_per_fragment"] is None
    empty_view = own_memory({"size": [1, 1], "counters": {"fragments": 0}, "memory_bytes": {"method": 4}})
    assert empty_view["bytes_per_fragment"] is None
