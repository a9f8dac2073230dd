"""
Small deliberate errors, each of which a test beside it must notice.

`tools/mutations/*.toml` is the table of errors; `Mutation` and `_numbers` have its keys. Each error
is written into a copy of the tree, never into the tree itself, and its tests run there:

    python tools/mutate.py --results mutations.jsonl

An interrupted run goes on where it was. Results are those of the module and the tests as they are
now: a changed one runs again, the test that noticed an error last time first, and all its tests
only if that one no longer does. `--check` only finds the texts.
"""

import argparse
import ast
import contextlib
import fnmatch
import functools
import hashlib
import importlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from imports import PACKAGE, imports_in, modules_in, packages_in, reach

ROOT = Path(__file__).resolve().parent.parent
TABLE = Path(__file__).resolve().parent / "mutations"
KINDS = {
    1: "tables of numbers",
    2: "oblong tiles, far points, remainders of blocks",
    3: "time",
    4: "band edges and filters",
    5: "chance",
    6: "capillary waves",
    7: "limits of formats",
    8: "bakes",
    9: "the machine",
    10: "benchmarks",
    11: "other",
}
COPIED = ("fftocean", "tests", "tools", "docs", "examples", "benchmarks", "notebooks")
COPIED_FILES = ("pyproject.toml", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff")
PRELOADED = ("numpy", "scipy.special", "scipy.integrate", "numba", "pyfftw", "pytest")
"""Packages that every run needs: imported once, before a run is forked."""

SILENT = ("baseline", "usage")
"""Outcomes of runs that say nothing: tests that fail without an error, or could not start."""

LEAST_LIMIT = 120.0  # time limit of the shortest tests [s]
LIMIT_FACTOR = 10.0  # time limit of the others, in times of the run without an error [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutation:
    """One deliberate error: a text of a module, what is written for it, the tests beside it."""

    module: str  # path from the root
    kind: int  # a key of `KINDS`
    old: str
    new: str
    tests: tuple[str, ...]
    why: str  # what breaks, hence why a test must fail
    equivalent: str = ""  # the reason, if nothing can break
    timeout_kills: bool = False  # a run past its limit counts as killed
    start: int = -1  # place of `old` in the module, where its text alone is not unique

    @property
    def name(self) -> str:
        """The module and the first eight digits of a checksum of the change."""
        changed = f"{self.module}\0{self.start}\0{self.old}\0{self.new}"
        return f"{self.module}:{hashlib.sha256(changed.encode()).hexdigest()[:8]}"

    def fault(self) -> str:
        """Return why the error cannot be made; "" if it can."""
        path = ROOT / self.module
        if not path.is_file():
            return f"{self.module}: no such module"
        if self.kind not in KINDS:
            return f"{self.name}: kind must be one of {min(KINDS)} to {max(KINDS)}, got {self.kind}"
        if missing := [t for t in self.tests if not (ROOT / t.partition("::")[0]).exists()]:
            return f"{self.name}: no such test: {missing[0]}"
        if not self.tests and not self.equivalent:
            return f"{self.name}: no tests"
        if self.old == self.new:
            return f"{self.name}: the new text is the old one"
        count = path.read_text().count(self.old) if self.start < 0 else 1
        if count != 1:
            return f"{self.name}: text found {count} times instead of once: {self.old!r}"
        try:
            compile(self.applied(), self.module, "exec")
        except SyntaxError as error:
            return f"{self.name}: the new text does not compile: {error}"
        return ""

    def applied(self) -> str:
        """Return the text of the module with the error in it."""
        text = (ROOT / self.module).read_text()
        start = text.index(self.old) if self.start < 0 else self.start
        return text[:start] + self.new + text[start + len(self.old) :]


@dataclass(frozen=True, slots=True)
class Result:
    """The answer of the tests to one error."""

    name: str
    key: str  # checksum of what the result depends on
    outcome: str  # killed, survived, timed out, equivalent; or an error: not found, baseline, usage
    seconds: float  # wall time of the tests
    test: str = ""  # the test that noticed


def read_table(folder: Path = TABLE) -> list[Mutation]:
    """Return all errors of the table, those generated from tables of numbers last."""
    mutations: list[Mutation] = []
    numbers: list[Mutation] = []
    for path in sorted(folder.glob("*.toml")):
        with path.open("rb") as file:
            table = tomllib.load(file)
        beside = table.get("tests", {})
        for entry in table.get("mutation", []):
            tests = tuple(entry.pop("tests", beside.get(entry["module"], [])))
            mutations.append(Mutation(tests=tests, **entry))
        for entry in table.get("numbers", []):
            numbers.extend(_numbers(**entry))
    return mutations + numbers


def _numbers(
    *, module: str, names: Sequence[str], tests: Sequence[str], factor: float, kind: int = 1
) -> Iterator[Mutation]:
    """Yield an error for each number in the assignments or functions `names`: `factor` times it."""
    text = (ROOT / module).read_text()
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    found = set()
    for node in ast.walk(ast.parse(text)):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        of = {t.id for t in targets if isinstance(t, ast.Name)}
        if isinstance(node, ast.FunctionDef):
            of = {node.name}
        if not of & set(names):
            continue
        found |= of
        for inner in ast.walk(node):
            if not isinstance(inner, ast.Constant) or type(inner.value) not in (int, float):
                continue
            # Columns count bytes of UTF-8.
            line = text.splitlines()[inner.lineno - 1].encode()
            column = len(line[: inner.col_offset].decode())
            old = ast.get_source_segment(text, inner)
            yield Mutation(
                module=module,
                kind=kind,
                old=old,
                new=repr(inner.value * factor if inner.value else factor - 1.0),
                tests=tuple(tests),
                why=f"a number of {', '.join(sorted(of))} is off by {factor - 1:.0%}",
                start=starts[inner.lineno - 1] + column,
            )
    if missing := set(names) - found:
        raise SystemExit(f"error: {module} assigns nothing to {', '.join(sorted(missing))}")


def faults(mutations: Sequence[Mutation]) -> list[str]:
    """Return what is wrong with the table: texts not found once, the same error twice."""
    twice = [name for name, n in Counter(m.name for m in mutations).items() if n > 1]
    return [f for m in mutations if (f := m.fault())] + [
        f"{name}: is there twice" for name in twice
    ]


def modules_without(mutations: Sequence[Mutation]) -> list[str]:
    """Return the modules with logic, a function that does something, of which no error is made."""
    named = {m.module for m in mutations}
    paths = sorted((ROOT / "fftocean").rglob("*.py"))
    return [
        name
        for path in paths
        if (name := path.relative_to(ROOT).as_posix()) not in named and _has_logic(path)
    ]


def _has_logic(path: Path) -> bool:
    """Return True if a module has a function that is more than a text and one plain statement."""
    functions = [
        node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)
    ]
    return any(_statements(function) > 1 for function in functions)


def _statements(function: ast.FunctionDef) -> int:
    """Return the number of statements of a function, without its text."""
    return (
        sum(isinstance(n, ast.stmt) for n in ast.walk(function))
        - 1
        - bool(ast.get_docstring(function))
    )


class Copy:
    """A copy of the tree, in which one error at a time is made."""

    def __init__(self, folder: Path) -> None:
        self.root = folder / "tree"
        self.compiled = folder / "numba"
        self.log = folder / "log.txt"
        for name in COPIED:
            ignored = shutil.ignore_patterns("node_modules", "__pycache__", ".venv*")
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, self.root / name, ignore=ignored, symlinks=True)
        for name in COPIED_FILES:
            shutil.copy2(ROOT / name, self.root / name)
        self.compiled.mkdir()

    def start(self, tests: Sequence[str], mutation: Mutation | None) -> int:
        """Make the error, start the tests in a process of their own, and return its number."""
        compiled = self.compiled
        if mutation is not None:
            path = self.root / mutation.module
            path.write_text(mutation.applied())
            # Byte code is taken for current if time (in seconds) and size of its source are, so
            # each error has a time of its own, long ago.
            stamp = 10**8 + int(mutation.name.rpartition(":")[2], 16) % 10**8
            os.utime(path, (stamp, stamp))
            if kernels := kernels_above(mutation.module):
                compiled = self.compiled.with_name("numba-of-one-error")
                # tests compile functions of their own from the kernels, too
                copied = shutil.ignore_patterns("test_*", *(f"{name}.*" for name in kernels))
                shutil.copytree(self.compiled, compiled, ignore=copied)
        pid = os.fork()
        if not pid:
            _run_tests(self.root, compiled, self.log, tests)
        return pid

    def restore(self, mutation: Mutation | None) -> None:
        """Undo the error."""
        if mutation is not None:
            shutil.copy2(ROOT / mutation.module, self.root / mutation.module)
            shutil.rmtree(self.compiled.with_name("numba-of-one-error"), ignore_errors=True)

    def noticed(self) -> str:
        """Return the first test of the log that failed."""
        lines = self.log.read_text(errors="replace").splitlines()
        found = [line for line in lines if line.startswith(("FAILED ", "ERROR "))]
        return found[0].split(" - ")[0].partition(" ")[2] if found else ""


def _run_tests(root: Path, compiled: Path, log: Path, tests: Sequence[str]) -> None:
    """Run tests in the tree at `root`, in a process just forked, and end it with their status."""
    status = 3
    try:
        os.setsid()
        file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        for stream in (1, 2):
            os.dup2(file, stream)
        os.chdir(root)
        os.environ["NUMBA_CACHE_DIR"] = str(compiled)
        os.environ["PYTHONPATH"] = str(root)
        sys.path[:] = [str(root), *(p for p in sys.path if p != str(ROOT / "tools"))]
        if numba := sys.modules.get("numba"):
            numba.config.CACHE_DIR = str(compiled)
        options = ["-x", "-q", "--tb=short", "-p", "no:cacheprovider"]
        options += ["-p", "no:zarr"]  # its plugin is slow to import
        status = int(sys.modules["pytest"].main([*options, *tests]))
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


@functools.cache
def _importers() -> dict[str, set[str]]:
    """Return, for each module of the package by name, the modules that import it."""
    sources, packages = modules_in(PACKAGE), packages_in(PACKAGE)
    found: dict[str, set[str]] = {}
    for name, source in sources.items():
        for imported in imports_in(name, source, sources, name in packages):
            found.setdefault(imported, set()).add(name)
    return found


@functools.cache
def kernels_above(module: str) -> tuple[str, ...]:
    """
    Return the last names of modules of compiled functions whose machine code may hold `module`.

    numba compares the time of the file that a function stands in, and of no other. So the code of
    the importers, with their constants and the functions that they call, is compiled anew.
    """
    name = ".".join(part for part in Path(module).with_suffix("").parts[1:] if part != "__init__")
    reached = {name} | reach(_importers(), name)
    sources = modules_in(PACKAGE)
    return tuple(sorted(m.rpartition(".")[2] for m in reached if "@compiled" in sources[m]))


class Runner:
    """Runs errors in several copies of the tree at once, and keeps the results in a file."""

    def __init__(self, folder: Path, results: Path, parallel: int) -> None:
        self.results = results
        # Runs that said nothing about an error are made again.
        found = read_results(results)
        self.known = {r.key: r for r in found if r.outcome not in SILENT}
        self.noticed = {r.name: r.test for r in found if r.outcome == "killed" and r.test}
        self.free = [Copy(folder / str(i)) for i in range(parallel)]
        self.at_work: dict[
            int, tuple[Copy, Mutation | None, float, float, Callable[..., None]]
        ] = {}

    def run(self, mutations: Sequence[Mutation]) -> list[Result]:
        """Return the results of all, in the order given."""
        pending = [m for m in mutations if not m.equivalent and key_of(m) not in self.known]
        # One test that fails because of an error is enough. The one that did so last time is sound
        # evidence of a changed module or file of tests too, as it passes without the error.
        last = [(m, (self.noticed[m.name],)) for m in pending if m.name in self.noticed]
        self._run(last, keep=("killed",))
        self._run([(m, m.tests) for m in pending if key_of(m) not in self.known])
        return [
            Result(m.name, "", "equivalent", 0.0) if m.equivalent else self.known[key_of(m)]
            for m in mutations
        ]

    def _run(
        self, pairs: Sequence[tuple[Mutation, tuple[str, ...]]], keep: Sequence[str] = ()
    ) -> None:
        """Run each error against its tests, which pass without it; keep these outcomes, or all."""
        for tests in dict.fromkeys(tests for _, tests in pairs):
            if baseline_key(tests) not in self.known:
                self._start(tests, None, 3600.0, baseline_key(tests), "baseline")
        self._wait()
        baselines = {tests: self.known[baseline_key(tests)] for _, tests in pairs}
        for mutation, tests in sorted(pairs, key=lambda pair: baselines[pair[1]].seconds):
            key, baseline = key_of(mutation), baselines[tests]
            if baseline.outcome != "survived":
                if not keep:
                    self._keep(Result(mutation.name, key, "baseline", 0.0, baseline.test))
                continue
            limit = max(LEAST_LIMIT, LIMIT_FACTOR * baseline.seconds)
            self._start(tests, mutation, limit, key, mutation.name, keep)
        self._wait()

    def _start(
        self,
        tests: Sequence[str],
        mutation: Mutation | None,
        limit: float,
        key: str,
        name: str,
        keep: Sequence[str] = (),
    ) -> None:
        while not self.free:
            self._poll()
        copy = self.free.pop()
        pid = copy.start(tests, mutation)
        now = time.monotonic()

        def done(outcome: str, seconds: float, test: str) -> None:
            if not keep or outcome in keep:
                self._keep(Result(name, key, outcome, seconds, test))

        self.at_work[pid] = (copy, mutation, now, now + limit, done)

    def _wait(self) -> None:
        while self.at_work:
            self._poll()

    def _poll(self) -> None:
        """Take in the runs that have ended, or have run past their limit; else rest a little."""
        time.sleep(0.05)
        for pid, (copy, mutation, begun, end, done) in list(self.at_work.items()):
            ended, status = os.waitpid(pid, os.WNOHANG)
            late = not ended and time.monotonic() > end
            if not ended and not late:
                continue
            with contextlib.suppress(ProcessLookupError):
                os.killpg(pid, signal.SIGKILL)  # also what the tests started
            if late:
                os.waitpid(pid, 0)
            outcome = "timed out" if late else _outcome(os.waitstatus_to_exitcode(status))
            if outcome == "usage" or (mutation is None and outcome != "survived"):
                print(copy.log.read_text(errors="replace")[-3000:])
            del self.at_work[pid]
            done(outcome, round(time.monotonic() - begun, 2), copy.noticed())
            copy.restore(mutation)
            self.free.append(copy)

    def _keep(self, result: Result) -> None:
        self.known[result.key] = result
        with self.results.open("a") as file:
            file.write(json.dumps(asdict(result)) + "\n")
        print(
            f"{result.outcome:10} {result.seconds:7.1f} s  {result.name}  {result.test}", flush=True
        )


def _outcome(status: int) -> str:
    """Return what the exit status of pytest says; a crash, or tests that cannot start, notices."""
    return "survived" if status == 0 else "usage" if status in (3, 4, 5) else "killed"


def key_of(mutation: Mutation) -> str:
    """Return a checksum of the error, its module and its tests."""
    return _checksum(
        mutation.name, _text(mutation.module), *map(_text, mutation.tests), *mutation.tests
    )


@functools.cache
def baseline_key(tests: Sequence[str]) -> str:
    """Return a checksum of the whole package and of tests."""
    package = sorted((ROOT / "fftocean").rglob("*.py"))
    return _checksum(*(p.read_text() for p in package), *map(_text, tests), *tests)


def _text(test: str) -> str:
    path = ROOT / test.partition("::")[0]
    files = sorted(path.rglob("*.py")) if path.is_dir() else [path] * path.is_file()
    return "".join(file.read_text() for file in files)


def _checksum(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:16]


def read_results(path: Path) -> list[Result]:
    """Return the results of a file; a last line cut short is left out."""
    found = []
    for line in path.read_text().splitlines() if path.exists() else []:
        try:
            found.append(Result(**json.loads(line)))
        except (json.JSONDecodeError, TypeError):
            continue
    return found


def summary(mutations: Sequence[Mutation], results: Sequence[Result]) -> str:
    """Return the kill rates by kind and by module, and what was not noticed, as Markdown."""
    pairs = list(zip(mutations, results, strict=True))
    lines = ["| kind | errors | killed | rate |", "|---|---:|---:|---:|"]
    for kind, words in KINDS.items():
        lines += _row(f"{kind} {words}", [p for p in pairs if p[0].kind == kind])
    lines += _row("all", pairs)
    lines += ["", "| package or module | errors | killed | rate |", "|---|---:|---:|---:|"]
    for group in sorted({_group(m) for m in mutations}):
        lines += _row(f"`{group}`", [p for p in pairs if _group(p[0]) == group])
    rest = [p for p in pairs if not _is_killed(*p)]
    lines += ["", "| not killed | outcome | change |", "|---|---|---|"]
    for mutation, result in rest:
        change = f"`{_short(mutation.old)}` → `{_short(mutation.new)}`: "
        change += mutation.equivalent or mutation.why
        lines.append(f"| `{mutation.module}` | {result.outcome} | {change} |")
    return "\n".join(lines) + "\n"


def _row(title: str, pairs: Sequence[tuple[Mutation, Result]]) -> list[str]:
    counted = [p for p in pairs if not p[0].equivalent]
    killed = sum(_is_killed(*p) for p in counted)
    rate = f"{killed / len(counted):.1%}" if counted else ""
    return [f"| {title} | {len(counted)} | {killed} | {rate} |"] if counted else []


def _group(mutation: Mutation) -> str:
    """Return the package that a module is in, two deep; the module itself at the top."""
    parts = mutation.module.split("/")[1:]
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def _is_killed(mutation: Mutation, result: Result) -> bool:
    late = result.outcome == "timed out" and mutation.timeout_kills
    return result.outcome == "killed" or late


def _short(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")[:80]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the status is 0 if 95 % are killed and the table is without faults."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[1])
    parser.add_argument("--check", action="store_true", help="only find the texts in the modules")
    parser.add_argument(
        "--only",
        metavar="PATTERN",
        action="append",
        help="names, or kinds as `kind:5`; may be given several times",
    )
    parser.add_argument("--results", type=Path, default=Path("mutations.jsonl"))
    parser.add_argument("--parallel", type=int, default=1, metavar="N")
    parser.add_argument("--summary", type=Path, help="write the rates into this file")
    parser.add_argument("--known", action="store_true", help="summarise without running anything")
    given = parser.parse_args(arguments)
    patterns = given.only or ["*"]
    mutations = [m for m in read_table() if any(_matches(m, p) for p in patterns)]
    for pattern in patterns:
        if not any(_matches(m, pattern) for m in mutations):
            parser.error(f"--only: no error's name or kind is {pattern!r}")
    wrong = faults(mutations)
    for line in wrong:
        print(f"error: {line}")
    if given.check:
        for module in modules_without(read_table()):
            print(f"note: no error is made in {module}")
        print(f"{len(mutations)} errors in {len({m.module for m in mutations})} modules")
        return bool(wrong)
    bad = {m.name for m in mutations if m.fault()}
    mutations = [m for m in mutations if m.name not in bad]
    for name in PRELOADED:
        importlib.import_module(name)
    with tempfile.TemporaryDirectory(prefix="mutate-") as folder:
        Path(folder).chmod(0o755)  # tests that give up the rights of root import modules there
        runner = Runner(Path(folder), given.results, 0 if given.known else given.parallel)
        if given.known:
            mutations = [m for m in mutations if m.equivalent or key_of(m) in runner.known]
        results = runner.run(mutations)
    text = summary(mutations, results)
    print(text)
    if given.summary:
        given.summary.write_text(_heading() + text)
    counted = [p for p in zip(mutations, results, strict=True) if not p[0].equivalent]
    killed = sum(_is_killed(*p) for p in counted)
    return bool(wrong) or killed < 0.95 * len(counted)


def _matches(mutation: Mutation, pattern: str) -> bool:
    if pattern.startswith("kind:"):
        return str(mutation.kind) == pattern[5:]
    return fnmatch.fnmatch(mutation.name, f"*{pattern}*")


def _heading() -> str:
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True
    ).stdout.strip()
    day = time.strftime("%Y-%m-%d")
    title = "# Deliberate errors and the tests that notice"
    return f"{title}\n\n{day}, commit {commit}, by `python tools/mutate.py`.\n\n"


if __name__ == "__main__":
    sys.exit(main())
