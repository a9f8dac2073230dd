"""Command line as a module: `python -m fftocean`."""

import sys

from fftocean.cli import main

if __name__ == "__main__":
    sys.exit(main())
