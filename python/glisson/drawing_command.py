"""What `glisson plot` and `glisson picture` run: one JSON object as argument, files as result, one line each."""

from __future__ import annotations

import json
import sys
from typing import Any

from ._charts import plot_run
from ._frames import RunError
from .pictures import picture


def main(arguments: list[str]) -> int:
    """:returns: 0 done, 1 failed, 2 what cannot be used, as the program's own."""
    wanted: dict[str, Any] = json.loads(arguments[0])
    kind = wanted.pop("kind")
    try:
        if kind == "plot":
            print(*(f"wrote {file}" for file in plot_run(**wanted)), sep="\n")
        else:
            picture(**wanted)
            print(f"wrote {wanted['file']}")
    except RunError as error:
        print(f"glisson: {error}", file=sys.stderr)
        return 2
    except (ImportError, OSError) as error:
        print(f"glisson: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
