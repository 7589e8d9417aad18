"""The command `ancf`."""

import sys

from ._ancf import main as _main


def main() -> None:
    """Runs the command line."""
    sys.exit(_main(["ancf", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
