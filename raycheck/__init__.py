"""The front door: command line, running tracers, the conformance suite."""

VERSION = "0.1.0"
