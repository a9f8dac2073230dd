"""`python -m fftocean`: the command line without its script."""

import sys

from fftocean.cli import main

if __name__ == "__main__":
    sys.exit(main())
