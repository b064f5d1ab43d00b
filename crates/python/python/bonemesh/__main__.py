"""`python -m bonemesh` is the command `bonemesh`."""

import sys

from bonemesh import main

if __name__ == "__main__":
    sys.exit(main())
