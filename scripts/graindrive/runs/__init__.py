"""Run folders: how a run records and keeps its data, resumes, and reports its progress."""
