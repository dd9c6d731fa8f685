"""Reports: verdicts and measurements in, pages for people and machines out. Judges nothing, runs nothing."""
