"""`python -m sheetbench`: the command line."""

from comparisons.cli import main

if __name__ == "__main__":
    main()
