"""The result of a scatter from its samples: means, standard deviations, quantiles and ranks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.scatter.samples import Study, frequency_slopes, nearest_margin, share_slopes, shares_at
from rotorgear.analysis.sensitivity.forms import participations
from rotorgear.results.scatter import (
    HIGH,
    LOW,
    FrequencyBand,
    GroupBand,
    MarginBand,
    ScatteredNumber,
    ScatterResult,
    ShareBand,
)
from rotorgear.solvers.sampling import SobolIndices, sobol_indices

Values = dict[str, NDArray[np.float64]]


def gathered(
    study: Study, Z: NDArray[np.float64], values: Values, samples: int, seed: int, least_margin: float
) -> ScatterResult:
    """Return the result, without what the verb alone knows.

    Args:
        study: what every sample was asked.
        Z: points (N, p): first those of the bands, then those of the Sobol indices.
        values: of each point: see `run_samples`.
        samples: how many points are of the bands.
        seed: of the bootstrap.
        least_margin: for the share of samples below it.
    """
    spreads = study.family.spreads
    of_bands = {name: value[:samples] for name, value in values.items()}
    slopes = np.vstack([frequency_slopes(study), share_slopes(study)])
    # Shares of the numbers in the variance to first order.
    square = slopes**2
    total = square.sum(axis=1, keepdims=True)
    shares = np.asarray(np.where(total > 0.0, square / np.where(total > 0.0, total, 1.0), 0.0))
    # Sobol indices of ln f and of the shares; a mode that is not found at some point has none.
    ranked = np.hstack([np.log(values["followed_hz"][samples:]), values["shares"][samples:]])
    nothing = np.zeros((0, len(spreads)))
    ranks = SobolIndices(nothing, nothing, nothing, nothing)
    if len(ranked):
        ranks = sobol_indices(ranked, len(spreads), seed)
    how = "each sample assembled" if study.family.terms is None else "forms summed over the numbers"
    rows = zip(
        spreads.numbers.addresses,
        spreads.numbers.start,
        spreads.numbers.unit,
        spreads.size,
        spreads.distribution,
        strict=True,
    )
    numbers = tuple(
        ScatteredNumber(address, float(value), unit, float(size), kind) for address, value, unit, size, kind in rows
    )
    return ScatterResult(
        model=spreads.numbers.model,
        speed=study.family.speed,
        numbers=numbers,
        bands=_bands(study, of_bands, slopes, shares, numbers),
        groups=_group_bands(study, of_bands),
        margins=_margin_bands(study, of_bands, least_margin),
        shares=_share_bands(study, of_bands, slopes[study.count :], shares[study.count :], numbers),
        least_margin=least_margin,
        sampling="",
        z=Z[:samples],
        sample_hz=of_bands["followed_hz"],
        sample_margin=of_bands["margin"],
        sample_share=of_bands["shares"],
        first_order_share=shares,
        sobol_first=ranks.first,
        sobol_total=ranks.total,
        sobol_first_error=ranks.first_error,
        sobol_total_error=ranks.total_error,
        basis_size=study.family.V.shape[1],
        frequency_basis_error=0.0,
        checked_samples=0,
        failed=int(np.sum(np.all(np.isnan(of_bands["hz"]), axis=1))),
        dofs=study.family.V.shape[0],
        method=f"modes in a basis of nominal modes and their derivatives, {how}",
    )


def _leading(shares: NDArray[np.float64], numbers: tuple[ScatteredNumber, ...]) -> tuple[str, float]:
    # Of parts that are alike the first in the file leads, not the one that rounding prefers.
    j = int(np.argmax(shares >= (1.0 - 1e-6) * np.max(shares)))
    return (numbers[j].address, float(shares[j])) if shares[j] > 0.0 else ("", 0.0)


def _bands(
    study: Study,
    values: Values,
    slopes: NDArray[np.float64],
    shares: NDArray[np.float64],
    numbers: tuple[ScatteredNumber, ...],
) -> tuple[FrequencyBand, ...]:
    rows = []
    for i in range(study.count):
        hz = values["followed_hz"][:, i]
        there = hz[np.isfinite(hz)]
        spread = float(np.std(np.log(there), ddof=1)) if len(there) > 1 else float("nan")
        low, high = np.quantile(there, [LOW, HIGH]) if len(there) else (np.nan, np.nan)
        rows.append(
            FrequencyBand(
                i + 1,
                float(study.nominal.omega[i] / (2.0 * np.pi)),
                next(k for k, group in enumerate(study.groups, 1) if i in group),
                float(np.sqrt(np.sum(slopes[i] ** 2))),
                spread,
                float(there.mean()) if len(there) else float("nan"),
                float(low),
                float(high),
                len(there) / len(hz),
                *_leading(shares[i], numbers),
            )
        )
    return tuple(rows)


def _group_bands(study: Study, values: Values) -> tuple[GroupBand, ...]:
    found = []
    for number, group in enumerate(study.groups, 1):
        own = [i for i in group if i < study.count]
        if len(own) < 2:
            continue
        hz = values["hz"][:, own]
        there = hz[np.isfinite(hz).all(axis=1)]
        if len(there):
            low = float(np.quantile(there.min(axis=1), LOW))
            high = float(np.quantile(there.max(axis=1), HIGH))
            found.append(GroupBand(number, tuple(i + 1 for i in own), low, high))
    return tuple(found)


def _margin_bands(study: Study, values: Values, least: float) -> tuple[MarginBand, ...]:
    taken = participations(study.names, study.lines, study.family.nominal, study.nominal)
    found = []
    for k, (line, hz) in enumerate(zip(study.lines, study.hz, strict=True)):
        nominal = nearest_margin(study.nominal.omega / (2.0 * np.pi), taken[k] >= study.share, float(hz))
        size = np.abs(values["margin"][:, k])
        there = size[np.isfinite(size)]
        low, median = np.quantile(there, [LOW, 0.5]) if len(there) else (np.nan, np.nan)
        below = float(np.mean(there < least)) if len(there) else 0.0
        found.append(MarginBand(line.name, float(hz), nominal, float(low), float(median), below))
    return tuple(found)


def _share_bands(
    study: Study,
    values: Values,
    slopes: NDArray[np.float64],
    shares: NDArray[np.float64],
    numbers: tuple[ScatteredNumber, ...],
) -> tuple[ShareBand, ...]:
    if not study.shared:
        return ()
    nominal = shares_at(study, np.zeros(len(study.family.spreads)))
    found = []
    for k, (gear, mesh) in enumerate(study.shared):
        seen = values["shares"][:, k]
        there = seen[np.isfinite(seen)]
        low, high = np.quantile(there, [LOW, HIGH])
        first = float(np.sqrt(np.sum(slopes[k] ** 2)))
        spread = float(np.std(there, ddof=1))
        leading = _leading(shares[k], numbers)
        found.append(ShareBand(gear, mesh, float(nominal[k]), first, spread, float(low), float(high), *leading))
    return tuple(found)
