"""
Executor on a Dask cluster: a local one, or that of a scheduler, whose workers see the same folder.
"""

import contextlib
import multiprocessing
import queue
import time
import uuid
from collections.abc import Generator, Sequence
from dataclasses import replace
from importlib import util
from pathlib import Path
from types import TracebackType
from typing import Any

from fftocean.baking.folder.journal import Entry
from fftocean.baking.folder.plan import Plan, Task
from fftocean.baking.workers.local import ATTEMPTS, ONE_THREAD
from fftocean.errors import FFTOceanError, JobError, OutputError, how_to_install
from fftocean.files import as_json, digest

PATIENCE = 10.0  # [s] for a scheduler to answer
START = 120.0  # [s] for the first worker of a local cluster, which imports the package, to be there
GUARD = (
    "each worker of executor 'dask' imports the main program: in a script, call bake under "
    "if __name__ == '__main__': (executor 'processes' needs no such guard)"
)
NO_DASHBOARD = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}
"""A scheduler serves HTTP even without a dashboard, on port 8787 and all interfaces if not told."""


def require_dask() -> None:
    """
    Raise if Dask is not installed.

    Raises:
        JobError: the package distributed is missing.
    """
    if util.find_spec("distributed") is None:
        raise JobError(f"executor 'dask' needs the package distributed: {how_to_install('dist')}")


def require_main_program() -> None:
    """
    Stop a worker that imports an unguarded script and so arrives at the script's own bake.

    Raises:
        SystemExit: this process is being started by another, which reports the error.
    """
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(f"fftocean: {GUARD}")


class Cluster:
    """
    Workers of a Dask cluster. Tasks that were finished may run again, and those of a worker that
    died do.

    A worker receives the plan and the numbers of frames, and returns their entries of the manifest.
    It writes the files straight to the folder, which all workers must see under the same name.
    """

    name = "dask"

    def __init__(self, address: str | None, workers: int) -> None:
        self.workers = workers
        self._address = address
        self._open = contextlib.ExitStack()
        self._client: Any = None

    def __enter__(self) -> "Cluster":
        import dask
        import distributed

        client: Any = distributed.Client
        cluster: Any = distributed.LocalCluster
        try:
            settings = {
                "distributed.nanny.pre-spawn-environ": ONE_THREAD,
                "distributed.scheduler.allowed-failures": ATTEMPTS - 1,
                "distributed.admin.log-format": "%(message)s",
                "logging": {"distributed": "critical"},
            }
            self._open.enter_context(dask.config.set(settings))
            address: Any = self._address
            if address is None:
                address = self._open.enter_context(
                    cluster(
                        n_workers=self.workers,
                        threads_per_worker=1,
                        dashboard_address=None,
                        scheduler_kwargs=NO_DASHBOARD,
                        silence_logs=50,
                        memory_limit=0,
                    )
                )
            own = self._address is None
            self._client = self._open.enter_context(
                client(address, timeout=START if own else PATIENCE, set_as_default=False)
            )
            self._client.wait_for_workers(1, timeout=START if own else 3 * PATIENCE)
            self.workers = len(self._client.scheduler_info(n_workers=-1)["workers"])
        except RuntimeError as error:
            self._open.close()
            if self._address is None and "failed to start" in str(error):
                raise JobError(
                    f"the workers of a local Dask cluster did not start: {GUARD}"
                ) from None
            raise
        except (OSError, TimeoutError, ValueError) as error:
            self._open.close()
            raise OutputError(
                f"{self._address or 'a local Dask cluster'} could not be reached: {error!s:.200}"
            ) from error
        except BaseException:
            self._open.close()
            raise
        return self

    def run(self, plan: Plan, tasks: Sequence[Task]) -> Generator[Entry, None, None]:
        """
        Submit all tasks, and yield each entry once.

        A worker reports a frame when it is finished, and again with its task, in case the first
        message was lost.
        """
        plan = replace(
            plan, folder=str(Path(plan.folder).absolute())
        )  # its workers have another current folder
        messages: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
        topic = f"fftocean-{uuid.uuid4().hex}"
        self._client.subscribe_topic(
            topic, lambda event: messages.put(("entry", event[1]["entry"]))
        )
        futures = [
            self._client.submit(
                _rendered, plan, task, topic, key=f"{topic}-{i}", pure=False, retries=0
            )
            for i, task in enumerate(tasks)
        ]
        try:
            for future in futures:
                future.add_done_callback(lambda done: messages.put(("done", done)))
            left, seen = len(futures), set()
            while left:
                try:
                    kind, value = messages.get(timeout=0.5)
                except queue.Empty:
                    continue
                left -= kind == "done"
                for entry in _result(value) if kind == "done" else [value]:
                    if (known := bytes.fromhex(digest(as_json(entry)))) not in seen:
                        seen.add(known)
                        yield entry
        finally:
            self._client.cancel(futures)
            with contextlib.suppress(Exception):
                self._client.unsubscribe_topic(topic)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._address is not None:  # its workers are not stopped: wait for their tasks to end
            deadline = time.monotonic() + PATIENCE
            with contextlib.suppress(Exception):
                while any(self._client.processing().values()) and time.monotonic() < deadline:
                    time.sleep(0.05)
        self._open.close()


def _result(future: Any) -> list[Entry]:
    """Return the entries of a finished task."""
    import distributed

    try:
        entries: list[Entry] = future.result()
    except FFTOceanError:
        raise
    except distributed.scheduler.KilledWorker as error:
        raise OutputError(
            f"some frames could not be baked: {ATTEMPTS} Dask workers died while baking them"
        ) from error
    return entries


def _rendered(plan: Plan, task: Task, topic: str) -> list[Entry]:
    """Carry out a task on a worker, and report each entry when it is finished."""
    import distributed

    from fftocean.baking.scene.scene import work

    worker, entries = distributed.get_worker(), []
    for entry in work(plan, task):
        worker.log_event(topic, {"entry": entry})
        entries.append(entry)
    return entries
