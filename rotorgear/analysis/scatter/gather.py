"""The result of a scatter from its samples: means, standard deviations, quantiles and ranks."""

from __future__ import annotations

from typing import Any

import numpy as np

from rotorgear.analysis.scatter.samples import Study, frequency_slopes, nearest_margin, share_slopes, shares_at
from rotorgear.analysis.sensitivity.forms import Floats
from rotorgear.results import scatter as results
from rotorgear.solvers.sampling import SobolIndices, sobol_indices

Values = dict[str, Floats]


def gathered(
    study: Study, Z: Floats, values: Values, samples: int, seed: int, least_margin: float, **known: Any
) -> results.ScatterResult:
    """Return the result.

    Args:
        study: what every sample was asked.
        Z: points (N, p): first those of the bands, then those of the Sobol indices.
        values: of each point: see `run_samples`.
        samples: how many points are of the bands.
        seed: of the bootstrap.
        least_margin: for the share of samples below it.
        known: fields of the result that the verb alone knows.
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
    columns = (spreads.numbers.start.tolist(), spreads.numbers.unit, spreads.size.tolist(), spreads.distribution)
    rows = zip(spreads.numbers.addresses, *columns, strict=True)
    # Standard deviation of each quantity to first order, and the number that makes most of it, with its share.
    pairs = zip(slopes, shares, strict=True)
    spread = [(float(np.sqrt(np.sum(row**2))), *_leading(share, spreads.numbers.addresses)) for row, share in pairs]
    return results.ScatterResult(
        model=spreads.numbers.model,
        speed=study.family.speed,
        numbers=tuple(results.ScatteredNumber(*row) for row in rows),
        bands=_bands(study, of_bands, spread[: study.count]),
        groups=_group_bands(study, of_bands),
        margins=_margin_bands(study, of_bands, least_margin),
        shares=_share_bands(study, of_bands, spread[study.count :]),
        least_margin=least_margin,
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
        failed=int(np.sum(np.all(np.isnan(of_bands["hz"]), axis=1))),
        dofs=study.family.V.shape[0],
        method=f"modes in a basis of nominal modes and their derivatives, {how}",
        **known,
    )


# Consecutive blocks of samples whose quantiles are compared: each block of a Sobol sequence fills the cube as evenly as it can.
_BLOCKS = 8


def quantile_error(values: Floats, share: float, blocks: int = _BLOCKS) -> float:
    """Standard error of the quantile of samples (n,), from those of blocks of them; NaN of fewer than two in a block.

    Errors of blocks of n/8 independent samples are sqrt(8) times as large, those of evenly placed ones up to 8 times: the
    stated one is true or up to three times too large. A Latin hypercube has no even blocks: of a quantity that hangs on one
    number alone it is some ten times better than stated.
    """
    size = len(values) // blocks
    if size < 2:
        return float("nan")
    each = np.quantile(values[: size * blocks].reshape(blocks, size), share, axis=1)
    return float(np.std(each, ddof=1) / np.sqrt(blocks))


def _leading(shares: Floats, addresses: tuple[str, ...]) -> tuple[str, float]:
    # Of parts that are alike the first in the file leads, not the one that rounding prefers.
    j = int(np.argmax(shares >= (1.0 - 1e-6) * np.max(shares)))
    return (addresses[j], float(shares[j])) if shares[j] > 0.0 else ("", 0.0)


def _bands(study: Study, values: Values, spread: list[tuple[float, str, float]]) -> tuple[results.FrequencyBand, ...]:
    rows = []
    for i, (first, leading, leading_share) in enumerate(spread):
        hz = values["followed_hz"][:, i]
        there = hz[np.isfinite(hz)]
        low, high = np.quantile(there, [results.LOW, results.HIGH]) if len(there) else (np.nan, np.nan)
        rows.append(
            results.FrequencyBand(
                i + 1,
                float(study.nominal.omega[i] / (2.0 * np.pi)),
                next(k for k, group in enumerate(study.groups, 1) if i in group),
                first,
                float(np.std(np.log(there), ddof=1)) if len(there) > 1 else float("nan"),
                float(there.mean()) if len(there) else float("nan"),
                float(low),
                float(high),
                len(there) / len(hz),
                leading,
                leading_share,
                low_error_hz=quantile_error(there, results.LOW),
                high_error_hz=quantile_error(there, results.HIGH),
            )
        )
    return tuple(rows)


def _group_bands(study: Study, values: Values) -> tuple[results.GroupBand, ...]:
    found = []
    for number, group in enumerate(study.groups, 1):
        own = [i for i in group if i < study.count]
        if len(own) < 2:
            continue
        hz = values["hz"][:, own]
        there = hz[np.isfinite(hz).all(axis=1)]
        if len(there):
            least = there.min(axis=1)
            most = there.max(axis=1)
            low = float(np.quantile(least, results.LOW))
            high = float(np.quantile(most, results.HIGH))
            errors = quantile_error(least, results.LOW), quantile_error(most, results.HIGH)
            found.append(results.GroupBand(number, tuple(i + 1 for i in own), low, high, *errors))
    return tuple(found)


def _margin_bands(study: Study, values: Values, least: float) -> tuple[results.MarginBand, ...]:
    taken = study.names.participations(study.lines, study.family.nominal, study.nominal)
    found = []
    for k, (line, hz) in enumerate(zip(study.lines, study.hz, strict=True)):
        nominal = nearest_margin(study.nominal.omega / (2.0 * np.pi), taken[k] >= study.share, float(hz))
        size = np.abs(values["margin"][:, k])
        there = size[np.isfinite(size)]
        low, median = np.quantile(there, [results.LOW, 0.5]) if len(there) else (np.nan, np.nan)
        below = float(np.mean(there < least)) if len(there) else 0.0
        error = quantile_error(there, results.LOW)
        found.append(
            results.MarginBand(line.name, float(hz), nominal, float(low), float(median), below, low_error=error)
        )
    return tuple(found)


def _share_bands(study: Study, values: Values, spread: list[tuple[float, str, float]]) -> tuple[results.ShareBand, ...]:
    if not study.shared:
        return ()
    nominal = shares_at(study, np.zeros(len(study.family.spreads)))
    found = []
    for k, ((gear, mesh), (first, leading, share)) in enumerate(zip(study.shared, spread, strict=True)):
        seen = values["shares"][:, k]
        there = seen[np.isfinite(seen)]
        low, high = np.quantile(there, [results.LOW, results.HIGH])
        sampled = (float(np.std(there, ddof=1)), float(low), float(high))
        errors = quantile_error(there, results.LOW), quantile_error(there, results.HIGH)
        found.append(results.ShareBand(gear, mesh, float(nominal[k]), first, *sampled, leading, share, *errors))
    return tuple(found)
