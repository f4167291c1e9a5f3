"""Runs the command line: python -m rotorgear."""

from rotorgear.cli.main import main

if __name__ == "__main__":
    main()
