"""The version, known to the package face and to every file that is written."""

__version__ = "0.7.0"
