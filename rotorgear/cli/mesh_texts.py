"""Texts of the options of `rotorgear mesh`: lists of factors, names with values, axes of a map."""

from __future__ import annotations

from rotorgear.errors import AnalysisError


def pairs_of(option: str, texts: list[str] | None) -> dict[str, str]:
    """Texts by name from 'name=text', several of them with commas or in several options.

    Raises:
        AnalysisError: something else.
    """
    found = {}
    for text in ",".join(texts).split(",") if texts else ():
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise AnalysisError(f"{option}: got '{text}', expected a name and its value, such as tip_relief=5 um")
        found[name] = value
    return found


def parse_over(texts: list[str]) -> dict[str, list[float]]:
    """Values in SI by axis from texts such as 'torque=500 N m:2000 N m:4,misalignment=0 um:10 um:20 um'.

    Raises:
        AnalysisError: no such axis, or values that are none.
    """
    from rotorgear.quantity import QuantityError, parse_quantity

    found: dict[str, list[float]] = {}
    for text in ",".join(texts).split(",") if texts else ():
        name, equals, values = (part.strip() for part in text.partition("="))
        dimension = {"torque": "torque", "misalignment": "length"}.get(name)
        if not equals or dimension is None:
            raise AnalysisError(f"--over: got '{text}', expected torque=... or misalignment=...")
        if name in found:
            raise AnalysisError(f"--over: '{name}' is given twice.")
        parts = [part.strip() for part in values.split(":")]
        count = int(parts.pop()) if len(parts) == 3 and parts[2].isdigit() else None
        try:
            numbers = [parse_quantity(part, dimension) for part in parts]
        except QuantityError as error:
            raise AnalysisError(
                f"--over {name}: got '{values}', expected {error}, such as '500 N m:2000 N m:4'"
            ) from None
        if count is None:
            found[name] = numbers
        elif 2 <= count <= 1000:
            first, last = numbers
            found[name] = [first + (last - first) * i / (count - 1) for i in range(count)]
        else:
            raise AnalysisError(f"--over {name}: got {count} values, expected 2 to 1000")
    return found


def parse_factors(text: str | None, option: str = "--load-factors") -> tuple[float, ...]:
    """Positive factors from a list with commas.

    Raises:
        AnalysisError: something else.
    """
    if text is None:
        return ()
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        raise AnalysisError(f"{option}: got '{text}', expected factors with commas, such as 0.1,0.5,2") from None
