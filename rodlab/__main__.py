"""`python -m rodlab`: the command line."""

from rodlab.cli import main

raise SystemExit(main())
