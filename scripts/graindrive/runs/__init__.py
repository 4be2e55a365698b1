"""Run folders: what a run records, keeps, resumes and says while it grows."""
