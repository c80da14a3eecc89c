"""A distribution in four numbers."""

import statistics


def quantiles(values: list[float]) -> list[float]:
    """Median, 90 %, 99 %, most, interpolated between the values; none of no values."""
    if len(values) < 2:
        return 4 * values
    cuts = statistics.quantiles(values, n=100, method="inclusive")
    return [statistics.median(values), cuts[89], cuts[98], max(values)]
