"""Workbooks of spreadsheets as the text that fits read: `python -m glisson.workbook RUNS.xlsx` writes RUNS.csv.

Numbers go over to their last digit, whatever the cells show. `glisson.fit` takes workbooks among its files by itself.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ._optional import need

FEWEST = 2  # numbers of a row, and rows, of a table


def to_csv(
    file: str | os.PathLike[str], out: str | os.PathLike[str] | None = None, *, sheet: str | None = None
) -> Path:
    """Writes a sheet of a workbook as text, and returns the file.

    :param file: a .xlsx or .xlsm
    :param out: the file to write; none: beside the workbook, with `.csv` for its ending
    :param sheet: name of the sheet; none: the one that holds numbers
    :raises ValueError: for a workbook without a table, with several of them (naming the sheets), or without that sheet
    """
    place = Path(file)
    book = need("openpyxl", "openpyxl", "workbooks").load_workbook(place, read_only=True, data_only=True)
    try:
        rows = _rows_of(book, place, sheet)
    finally:
        book.close()
    written = Path(out) if out is not None else place.with_suffix(".csv")
    with written.open("w", newline="", encoding="utf-8") as target:
        csv.writer(target).writerows([_text(cell) for cell in row] for row in rows)
    return written


def _rows_of(book: Any, place: Path, sheet: str | None) -> list[tuple[Any, ...]]:
    """The rows of the sheet that is meant."""
    sheets = {name: list(book[name].iter_rows(values_only=True)) for name in book.sheetnames}
    if sheet is not None:
        if sheet not in sheets:
            raise ValueError(f'{place} has no sheet "{sheet}"; it has {", ".join(sheets)}')
        return sheets[sheet]
    tables = [name for name, rows in sheets.items() if _is_table(rows)]
    if len(tables) == 1:
        return sheets[tables[0]]
    if not tables:
        raise ValueError(f"{place} has no sheet with rows of numbers; it has {', '.join(sheets)}")
    call = f'python -m glisson.workbook {place} --sheet "{tables[0]}"'
    raise ValueError(f"{place} has {len(tables)} sheets with numbers: {', '.join(tables)}; write one of them by `{call}`")


def _is_table(rows: Sequence[Sequence[Any]]) -> bool:
    def numbers(row: Sequence[Any]) -> int:
        return sum(isinstance(cell, (int, float)) and not isinstance(cell, bool) for cell in row)

    return sum(numbers(row) >= FEWEST for row in rows) >= FEWEST


def _text(cell: Any) -> str:
    """A cell with all its digits."""
    if cell is None:
        return ""
    if isinstance(cell, float):
        return repr(cell)
    if isinstance(cell, (datetime.datetime, datetime.date, datetime.time)):
        return cell.isoformat()
    return str(cell)


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m glisson.workbook", description="A sheet of a workbook as .csv.")
    parser.add_argument("file", help="a .xlsx or .xlsm")
    parser.add_argument("--sheet", help="name of the sheet; default: the one that holds numbers")
    parser.add_argument("--out", help="the file to write; default: beside the workbook")
    options = parser.parse_args(arguments)
    try:
        print(to_csv(options.file, options.out, sheet=options.sheet))
    except (ImportError, OSError, ValueError) as error:
        print(f"glisson.workbook: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
