"""What `scripts/run` starts: the file of a study, run as Python itself runs it; a file that starts no study is refused."""

import sys

from ..base import output


def main():
    """Run the file that the first argument names; end with code 2 if it has not called `headless.main`."""
    file = sys.argv[1]
    output.run_program()
    from . import headless  # the study's file has imported it, unless it is none

    if not headless.was_called:
        space = sys.modules["__main__"].__dict__
        if "STUDY" in space:
            missing = 'defines STUDY, but does not run it: end the file with `if __name__ == "__main__": headless.main(STUDY)`'
        else:
            missing = 'defines no STUDY; a YADE script is run by `yade -n -x` after `eval "$(scripts/env)"`, a study is made as'
        print(f"{file} {missing}, see studies/guides/study.md", file=sys.stderr)
        sys.exit(2)
