"""Choice of an executor by its name."""

from fftocean.baking.workers import cluster
from fftocean.baking.workers.local import Executor, Processes, Serial
from fftocean.errors import JobError, suggestion
from fftocean.job.parameters import spelled

EXECUTORS = ("auto", "serial", "processes", "dask")


def check_executor(name: str, workers: int | None) -> str:
    """
    Return an executor's name in its standard spelling.

    Raises:
        JobError: the name is unknown, the number of workers out of range, or Dask not installed.
    """
    name = spelled(name, EXECUTORS) or name
    if name not in EXECUTORS and "://" not in name:
        raise JobError(
            f"executor must be one of {', '.join(EXECUTORS)}, or an address such as "
            f"tcp://host:8786, got {name!r:.80}{suggestion(name, EXECUTORS)}"
        )
    if workers is not None and (
        isinstance(workers, bool) or not isinstance(workers, int) or not 1 <= workers <= 1024
    ):
        raise JobError(f"workers must be a whole number between 1 and 1024, got {workers!r:.40}")
    if name == "dask" or "://" in name:
        cluster.require_dask()
        if name == "dask":
            cluster.require_main_program()
    return name


def choose_executor(name: str, workers: int, lock: int) -> Executor:
    """
    Return the executor of a name, to be used as a context.

    Args:
        name: one of `EXECUTORS` but "auto", or a scheduler's address.
        workers: number of workers; ignored for a scheduler, which has its own.
        lock: descriptor of the folder's lock, which workers on this machine inherit.
    """
    if name == "serial":
        return Serial()
    if name == "processes":
        return Processes(workers, lock)
    return cluster.Cluster(None if name == "dask" else name, workers)
