"""One module a command, imported when it runs; each has run(options) -> exit code."""
