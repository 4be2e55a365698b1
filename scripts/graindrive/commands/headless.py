"""Runs a study as a command: no open port in batch mode, clear messages, correct exit codes, no files left behind."""

import atexit
import gc
import os
import shutil
import signal
import socketserver
import sys
import threading
import traceback
from pathlib import Path

from ..base import output, signals
from ..exports import exports
from ..runs import run_data
from ..beds.cache import cache_folder
from .command_line import parameters_or_exit
from ..base.errors import EngineError, Interrupted, UsageError, is_full, one_line
from ..runs.run_folder import RunFolder
from ..runs import run_place
from ..runs.run_place import AlreadyComplete

was_called = False  # by the study's file; `run_study` asks

# This must precede any import of matplotlib: its font list goes into our cache, not into the home folder.
os.environ.setdefault("MPLCONFIGDIR", str(cache_folder() / "matplotlib"))


def main(study):
    """Run a `Study` as a command and end the program with the right exit code.

    In batch mode (`yade -x`, or no terminal) the exit code is 0 after success, 2 after a UsageError, 128 + n after signal n, 1
    after any other failure. In a terminal a successful run returns to YADE's console.
    """
    global was_called
    was_called = True
    output.forgive()
    leave_nothing_behind()
    p = parameters_or_exit(study, sys.argv[1:])
    batch = is_batch()
    if batch:
        close_servers()
    code = guarded(lambda: carry_out(study, p), study.name)
    if batch or code:
        end(code)


def end(code):
    """End the program with this exit code, even if HDF5 could not write a file (its own exit handler would then crash).

    The run has ended by now, so Ctrl-C is ignored: it would only interrupt the interpreter's exit and print a traceback.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    if run_data.files_stay_open():
        remove_yades_folder()
        os._exit(code)
    sys.exit(code)


def carry_out(study, p):
    """Run the `Study` in its run folder, open to stop signals, and film it if asked; an impossible film is refused first."""
    if p.film:
        films().require_possible(study, p)
    try:
        made(study, p)
    except AlreadyComplete:
        exported(study, p)
        filmed(study, p)
        raise
    filmed(study, p)


def exported(study, p):
    """Write the exports that are asked for and that a run made earlier does not hold."""
    if p.exports and (names := exports.write_missing(run_place.place_of(p.out), p.exports)):
        print(f"{study.name}: wrote {', '.join(names)}", file=sys.stderr)


def filmed(study, p):
    """Film the finished run if that is asked for and no film is there."""
    out = run_place.place_of(p.out)
    if p.film and not (out / films().NAME).exists():
        print(f"{study.name}: filming {films().NAME}", file=sys.stderr)
        study.film(out)


def films():
    """Return the module of films; matplotlib, which it needs, takes a second that other runs save."""
    from ..postproc import films as module

    return module


def made(study, p):
    """Run the `Study` in its run folder, with stop signals handled."""
    kept = dict(figure=study.figure, constants=study.constants, observables=study.observables, family=study.family)
    if p.choice:
        print(f"{study.name}: accuracy={p.accuracy}: {p.choice.words}", file=sys.stderr)
    for key, condition in p.given_in_vain.items():
        print(f"{study.name}: this run does not use {key}, which needs {condition.rule}", file=sys.stderr)
    with signals.handled(), RunFolder(p, study=study.name, **kept) as folder:
        if p.choice:
            folder.note(**p.choice.facts())
        study.run(p, folder)
    print(f"{study.name}: done, see {folder.out}", file=sys.stderr)


def guarded(action, name):
    """Call `action()` and return the exit code; print a failure on stderr."""
    try:
        action()
        return 0
    except AlreadyComplete as there:
        print(f"{name}: {there}", file=sys.stderr)
        return 0
    except UsageError as error:
        if is_debugging():
            traceback.print_exc()
        print(f"{name}: error: {one_line(error, 1000)}", file=sys.stderr)
        return UsageError.exit_code
    except (Interrupted, KeyboardInterrupt) as stop:
        number = getattr(stop, "signal_number", signal.SIGINT)
        print(f"{name}: stopped by {signal.Signals(number).name}", file=sys.stderr)
        return 128 + number
    except Exception as error:
        if not (isinstance(error, EngineError) or is_full(error)) or is_debugging():
            traceback.print_exc()
        print(f"{name}: failed: {type(error).__name__}: {one_line(error, 500)}", file=sys.stderr)
        if is_full(error):
            print(
                f"{name}: failed: the disk or the quota is full; free some space, then continue with resume=1",
                file=sys.stderr,
            )
        return 1


def is_debugging():
    """True if $GRAINDRIVE_DEBUG asks for tracebacks of all errors."""
    return os.environ.get("GRAINDRIVE_DEBUG", "0") not in ("", "0")


def is_batch():
    """True under `yade -x` and without a terminal."""
    runtime = sys.modules.get("yade.runtime")
    asked = getattr(getattr(runtime, "opts", None), "exitAfter", False)
    return bool(asked) or not (sys.stdin is not None and sys.stdin.isatty())


def close_servers():
    """Close YADE's Python console (TCP 9000 or next) and XML-RPC server (21000 or next); RuntimeError if one stays open.

    YADE's program starts both before any script and keeps no reference to them. `yade-batch` then shows no progress on
    its web page; its queue and its exit codes do not need the servers.
    """
    servers = [o for o in gc.get_objects() if isinstance(o, socketserver.BaseServer) and is_yades(o)]
    ports = {server.server_address[1] for server in servers}
    stopping = [threading.Thread(target=server.shutdown) for server in servers]
    for thread in stopping:
        thread.start()
    for thread in stopping:
        thread.join()
    for server in servers:
        server.server_close()
    left = ports & listening_ports()
    if left:
        raise RuntimeError(f"YADE's servers still listen on ports {sorted(left)}")


def is_yades(server):
    """True for the two servers that `yade.remote.runServers` starts."""
    remote = sys.modules.get("yade.remote")
    if remote is None:
        return False
    is_console = getattr(server, "RequestHandlerClass", None) is remote.PythonConsoleSocketEmulator
    return is_console or isinstance(getattr(server, "instance", None), remote.InfoProvider)


def listening_ports():
    """Return the set of TCP ports on which this process listens, from /proc."""
    inodes = set()
    for descriptor in Path("/proc/self/fd").iterdir():
        try:
            target = os.readlink(descriptor)
        except OSError:
            continue
        if target.startswith("socket:["):
            inodes.add(target[8:-1])
    rows = [row.split() for table in ("tcp", "tcp6") for row in socket_table(table)]
    return {int(row[1].rpartition(":")[2], 16) for row in rows if row[3] == "0A" and row[9] in inodes}


def socket_table(name):
    """Return the lines of /proc/self/net/`name` without the heading; none if the kernel has no such table."""
    try:
        return Path("/proc/self/net", name).read_text().splitlines()[1:]
    except OSError:
        return []


def leave_nothing_behind():
    """Arrange that YADE's folder below /tmp is removed at exit."""
    if "yade" in sys.modules:
        atexit.register(remove_yades_folder)


def remove_yades_folder():
    """Remove YADE's folder below /tmp, if YADE runs in this process."""
    if "yade" in sys.modules:
        from yade import O

        shutil.rmtree(os.path.dirname(O.tmpFilename()), ignore_errors=True)
