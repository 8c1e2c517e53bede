"""Cells to answers: here, in a pool of processes, or on a cluster; what a journal knows already is not asked again.

Any `concurrent.futures.Executor` will do: a process pool for one machine, Dask's or mpi4py's for many.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from typing import Any

from rodlab.lab.studies.cells import Cell, answer
from rodlab.lab.studies.journal import Journal
from rodlab.numerics.arrays import whole

MOST = 1000  # processes
PATIENCE = "20s"  # with a cluster that does not answer
Watch = Callable[[int, int], None]  # cells finished, cells in all


def answers(
    cells: Sequence[Cell], executor: Executor | None = None, journal: Journal | None = None, watch: Watch | None = None
) -> list[dict[str, Any]]:
    """The cells' answers in their order. A kill or an interrupt loses only the cells that are being computed."""
    listed = list(cells)
    known = journal.known(listed) if journal else {}
    found, open_cells = dict(known), [i for i in range(len(listed)) if i not in known]
    if watch:
        watch(len(known), len(listed))
    for done, (i, result) in enumerate(_computed(listed, open_cells, executor), start=len(known) + 1):
        if journal and "crashed" not in result:  # what depends on the state of the machine is asked again
            journal.keep(listed[i], result)
        found[i] = result
        if watch:
            watch(done, len(listed))
    return [found[i] for i in range(len(listed))]


def _computed(cells: Sequence[Cell], wanted: Sequence[int], executor: Executor | None) -> Iterator[tuple[int, dict[str, Any]]]:
    """(place, answer) as they are finished."""
    if executor is None:
        yield from ((i, answer(cells[i])) for i in wanted)
        return
    futures = {executor.submit(answer, cells[i]): i for i in wanted}
    died: BrokenExecutor | None = None
    try:
        for future in as_completed(futures):
            try:
                found = future.result()
            except BrokenExecutor as error:
                died = error  # what others have finished is still to be kept
                continue
            yield futures[future], found
    finally:
        for future in futures:
            future.cancel()
    if died is not None:
        raise ArithmeticError(
            f"a worker died, perhaps for want of memory ({str(died) or 'no reason given'}); "
            "finished cells are kept with --out: the same command goes on from there, with fewer --jobs if need be"
        )


@contextmanager
def workers(jobs: int = 1, cluster: str | None = None) -> Iterator[Executor | None]:
    """An executor for `jobs` processes on this machine (None for one), or for a cluster.

    cluster: "local" starts Dask's on this machine with `jobs` workers; an address is that of Dask's scheduler.
    """
    jobs = whole("jobs", jobs, least=1)
    if jobs > MOST:
        raise ValueError(f"jobs must be at most {MOST}; it is {jobs}")
    if cluster is not None:
        with _dask(cluster, jobs) as executor:
            yield executor
    elif jobs == 1:
        yield None
    else:
        from multiprocessing import get_context

        pool = Processes(jobs, mp_context=get_context("spawn"), initializer=_leave_with_parent)
        try:
            yield pool
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


class Processes(ProcessPoolExecutor):
    """A pool whose processes do not run the caller's script again: cells live here, and a script may have no guard."""

    def submit(self, *args: Any, **kwargs: Any) -> Future[Any]:
        """As its parent's; a process is started by the submission that needs it."""
        with _without_main():
            return super().submit(*args, **kwargs)


def _leave_with_parent() -> None:
    """A worker whose parent was killed would wait for ever: leave when it ends."""
    import os
    import threading
    from multiprocessing import parent_process
    from multiprocessing.connection import wait

    parent = parent_process()
    if parent is None:
        return
    sentinel = parent.sentinel

    def watch() -> None:
        wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _without_main() -> Iterator[None]:
    """Without what tells a new process to run the caller's script."""
    import sys

    main = sys.modules["__main__"]
    kept = {name: getattr(main, name) for name in ("__file__", "__spec__") if hasattr(main, name)}
    for name in kept:
        setattr(main, name, None)
    try:
        yield
    finally:
        for name, value in kept.items():
            setattr(main, name, value)


@contextmanager
def _dask(address: str, jobs: int) -> Iterator[Executor]:
    try:
        import distributed
    except ImportError:
        raise ValueError(f'cluster must be left out, or pip install "rodlab[cluster]" for Dask; it is {address!r}') from None
    with _without_main(), ExitStack() as opened:
        dask: Any = distributed
        try:
            if address == "local":
                address = opened.enter_context(dask.LocalCluster(n_workers=jobs, threads_per_worker=1, dashboard_address=None))
            client = opened.enter_context(dask.Client(address, timeout=PATIENCE))
        except (OSError, ValueError) as error:
            said = f"cluster must be local or the address of a Dask scheduler; {address!r} does not answer: {error}"
            raise ValueError(said) from None
        yield client.get_executor(pure=False)
