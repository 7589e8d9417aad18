"""Python's values as those of a scene, which is TOML."""

from __future__ import annotations

import json
import math
import numbers
from collections.abc import Mapping
from typing import Any


def plain(value: Any, path: str) -> Any:
    """`value` of plain types; arrays and numbers of NumPy become lists and numbers.

    Raises TypeError or ValueError, which name `path`, where a scene has no such value.
    """
    if isinstance(value, (str, bool)):
        return str(value) if isinstance(value, str) else value
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise TypeError(f"{path}: the keys of a table are text, found {key!r}")
        return {key: plain(entry, f"{path}.{key}" if path else key) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry, f"{path}.{index}") for index, entry in enumerate(value)]
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        if not math.isfinite(value):
            raise ValueError(f"{path}: expected a finite number, found {value}")
        return float(value)
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        return plain(value.tolist(), path)
    found = "None" if value is None else f"a value of type {type(value).__name__}"
    raise TypeError(f"{path}: expected a number, text, a list or a table, found {found}")


def inline(value: Any) -> str:
    """A plain value as TOML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {inline(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(inline(entry) for entry in value) + "]"
    # Numbers, truth values and texts of JSON are such of TOML, but for a character that it lets stand.
    return json.dumps(value, ensure_ascii=False, allow_nan=False).replace("\x7f", "\\u007f")


def document(table: dict[str, Any]) -> str:
    """A plain table as a scene's text, a line per value."""
    lines: list[str] = []

    def write(table: dict[str, Any], path: tuple[str, ...]) -> None:
        values = {key: value for key, value in table.items() if not isinstance(value, dict)}
        if path and (values or not table):
            lines.append("[" + ".".join(_key(key) for key in path) + "]")
        lines.extend(f"{_key(key)} = {inline(value)}" for key, value in values.items())
        for key, value in table.items():
            if isinstance(value, dict):
                write(value, (*path, key))

    write(table, ())
    return "\n".join(lines) + "\n"


def text(value: Any, path: str) -> str:
    """A value as overrides and sweeps write it; texts stand as on the command line."""
    if isinstance(value, str):
        return value
    return inline(plain(value, path))


def _key(key: str) -> str:
    bare = key.replace("_", "").replace("-", "")
    if bare.isascii() and bare.isalnum():
        return key
    return json.dumps(key, ensure_ascii=False)
