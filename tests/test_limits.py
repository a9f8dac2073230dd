"""The ranges of quantities, the messages of their checks, and the constructors that use them."""

import itertools
import math
import re
import sys
import warnings
from decimal import Decimal
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from fftocean import arrays, errors, host, limits
from fftocean.errors import ParameterError, SeaWarning
from fftocean.limits import Count, Quantity
from fftocean.physics.sea import Sea, WaveSystem, from_compass
from fftocean.physics.spectra import (
    JONSWAP,
    TMA,
    CustomSpectrum,
    PiersonMoskowitz,
    TabulatedSpectrum,
)
from fftocean.physics.spreading import Blend, CosinePower

QUANTITIES = {name: value for name, value in vars(limits).items() if isinstance(value, Quantity)}
COUNTS = {name: value for name, value in QUANTITIES.items() if isinstance(value, Count)}

# One quantity


@pytest.mark.parametrize("name", sorted(QUANTITIES.keys() - COUNTS.keys()))
def test_ends_are_inside_and_the_next_float_is_not(name):
    q = QUANTITIES[name]
    for end, outward in ((q.low, -math.inf), (q.high, math.inf)):
        assert q.check("x", end) == end
        beyond = math.nextafter(float(end), outward)
        if beyond != end:
            with pytest.raises(
                ParameterError,
                match=rf"^x must be {re.escape(q.rule)}, got {re.escape(repr(beyond))}$",
            ):
                q.check("x", beyond)


@pytest.mark.parametrize(
    "bad",
    [
        "5",
        b"5",
        True,
        False,
        np.True_,
        None,
        1j,
        [1.0],
        np.array(1.0),
        np.array([1.0]),
        Decimal(1),
        object,
        {},
    ],
)
def test_what_is_no_number_is_refused(bad):
    """
    A message names the thing, the rule, the value and its type: a text "5" and a number 5 look
    alike in a job file.
    """
    for q in QUANTITIES.values():
        noun = "whole number" if isinstance(q, Count) else "number"
        with pytest.raises(ParameterError) as error:
            q.check("thing", bad)
        assert (
            str(error.value)
            == f"thing must be a {noun} {q.rule}, got {bad!r:.60} ({type(bad).__name__})"
        )


@pytest.mark.parametrize("name", sorted(QUANTITIES))
def test_nan_is_nowhere_inside(name):
    for nan in (math.nan, np.float64("nan"), np.float32("nan")):
        with pytest.raises(ParameterError, match=r"^x must be .*, got .*nan"):
            QUANTITIES[name].check("x", nan)


def test_every_kind_of_real_number_becomes_a_plain_float():
    q = limits.DIRECTION
    for value in (
        3,
        3.0,
        np.float64(3.0),
        np.float32(3.0),
        np.float16(3.0),
        np.int8(3),
        np.uint64(3),
        np.longdouble(3.0),
        Fraction(3),
    ):
        checked = q.check("x", value)
        assert checked == 3.0
        assert type(checked) is float


def test_numbers_beyond_the_floats_are_infinite():
    """
    10^400 is no float: where inf is allowed it is inf, elsewhere it is refused as such, not with an
    OverflowError.
    """
    assert limits.DEPTH.check("depth", 10**400) == math.inf
    with pytest.raises(ParameterError, match=r"fetch must be between 1 and 5e\+07 m, got inf"):
        limits.FETCH.check("fetch", 10**400)


def test_rules_in_words():
    assert limits.FETCH.rule == "between 1 and 5e+07 m"
    assert limits.DEPTH.rule == "at least 1e-06 m (inf is allowed)"
    assert limits.FRACTION.rule == "between 0 and 1"
    largest, smallest = sys.float_info.max, math.nextafter(0.0, 1.0)
    assert Quantity("m", 0.0, largest).rule == "at least 0 m and finite"
    assert Quantity("m", smallest, largest).rule == "positive and finite"
    assert Quantity("m", -largest, largest).rule == "finite"
    assert limits.COORDINATE.rule == "of any size"


def test_a_long_value_is_cut_short():
    """A 100 kB string in a job file must not become a 100 kB message."""
    with pytest.raises(ParameterError) as error:
        limits.FETCH.check("fetch", "9" * 100_000)
    assert len(str(error.value)) < 200


@pytest.mark.parametrize("name", sorted(COUNTS))
def test_counts_are_whole(name):
    q = COUNTS[name]
    assert q.check("n", q.high) == q.high
    assert q.check("n", np.int64(q.low)) == q.low
    assert type(q.check("n", np.uint8(q.low))) is int
    for bad in (
        7.0,
        7.5,
        np.float64(7.0),
        "7",
        True,
        np.True_,
        None,
        math.nan,
        math.inf,
        Fraction(7),
    ):
        with pytest.raises(ParameterError) as error:
            q.check("n", bad)
        assert (
            str(error.value)
            == f"n must be a whole number {q.rule}, got {bad!r} ({type(bad).__name__})"
        )
    for bad in (q.low - 1, q.high + 1, 10**400, -(10**400)):
        with pytest.raises(ParameterError) as error:
            q.check("n", bad)
        assert str(error.value) == f"n must be a whole number {q.rule}, got {bad}"


def test_the_last_seed_is_told_from_the_next():
    """2^64 - 1 and 2^64 are one float: counts are compared as integers."""
    assert limits.SEED.check("seed", 2**64 - 1) == 2**64 - 1
    with pytest.raises(ParameterError, match="seed must be a whole number"):
        limits.SEED.check("seed", 2**64)


def test_a_count_has_one_verb():
    """A count passed where a quantity is expected refuses fractions too."""
    counted: Quantity = limits.SAMPLES
    assert type(counted.check("n", 7)) is int
    with pytest.raises(ParameterError, match="n must be a whole number"):
        counted.check("n", 7.0)
    with pytest.raises(ParameterError, match="n must be a whole number"):
        limits.keep_checked(SimpleNamespace(n=7.0), n=counted)


# An array of them


def refusal(values, quantity=limits.FETCH, **rules) -> str:
    """Return the message with which an array is refused."""
    with pytest.raises(ParameterError) as error:
        quantity.check_array("x", values, **rules)
    return str(error.value)


@pytest.mark.parametrize(
    "values",
    [
        [1.0, 2.0, 4.0],
        (1, 2.0, np.float32(4.0)),
        range(1, 8, 3),
        iter([1, 2, 4]),
        [Fraction(1), Fraction(2), 4],
        np.array([1, 2, 4], np.uint8),
        np.array([1, 2, 4], np.float16),
        np.array([1, 2, 4], np.longdouble),
        np.array([Fraction(1), 2, 4.0], object),
        np.array([1.0, 0.0, 2.0, 0.0, 4.0])[::2],
        np.ma.masked_array([1.0, 2.0, 4.0], mask=False),
    ],
    ids=repr,
)
def test_numbers_in_any_container_become_a_float64_array(values):
    expected = [1.0, 4.0, 7.0] if isinstance(values, range) else [1.0, 2.0, 4.0]
    array = limits.FETCH.check_array("x", values)
    assert type(array) is np.ndarray
    assert array.dtype == np.float64
    assert array.tolist() == expected


def test_arrays_of_every_dimension_keep_their_shape():
    for shape in ((), (3,), (2, 3), (0,), (2, 0, 3)):
        assert limits.FETCH.check_array("x", np.ones(shape)).shape == shape
        if 0 not in shape:
            assert limits.FETCH.check_array("x", np.ones(shape).tolist()).shape == shape
    assert limits.FETCH.check_array("x", [np.ones(3), np.ones(3)]).shape == (2, 3)


def test_a_float64_array_is_not_copied():
    given = np.array([1.0, 2.0])
    assert limits.FETCH.check_array("x", given) is given


@pytest.mark.parametrize("bad", [0.5, math.nan, -math.inf, 1e308])
def test_an_entry_out_of_range_is_named(bad):
    table = [[1.0, 2.0], [3.0, bad]]
    message = f"x[1][1] must be between 1 and 5e+07 m, got {bad}"
    assert refusal(table) == message
    assert refusal(np.array(table)) == message
    assert refusal(np.array(bad)) == f"x must be between 1 and 5e+07 m, got {bad}"


@pytest.mark.parametrize("bad", ["5", b"5", True, np.True_, None, 1j, Decimal(5), {5: 5}, object])
def test_an_entry_that_is_no_number_is_named(bad):
    """NumPy would make numbers of most of these, and some of them silently."""
    got = f"must be a number between 1 and 5e+07 m, got {bad!r:.60} ({type(bad).__name__})"
    assert refusal([1.0, bad]) == f"x[1] {got}"
    assert refusal(np.array([1.0, bad], object)) == f"x[1] {got}"
    if not isinstance(bad, np.bool_):
        assert refusal(bad) == f"x {got}"


@pytest.mark.parametrize("kind", ["bool", "complex128", "U3", "S3", "datetime64[s]"])
def test_arrays_of_other_types_are_refused(kind):
    array = np.ones(2).astype("int64").astype(kind)
    message = f"x must be numbers between 1 and 5e+07 m, got {array!r:.60} ({array.dtype})"
    assert refusal(array) == " ".join(line.strip() for line in message.splitlines())


def test_rows_of_different_lengths_are_refused():
    assert refusal([[1.0], [1.0, 2.0]]) == (
        "x must be numbers in a regular array, got [[1.0], [1.0, 2.0]]"
    )


def test_masked_entries_are_refused_or_become_nan():
    """A masked entry holds a number, but one that stands for nothing."""
    masked = np.ma.masked_array([1, 2], mask=[False, True])
    assert refusal(masked).startswith("x must have no masked entries, got masked_array(")
    assert np.array_equal(
        limits.FETCH.check_array("x", masked, missing=True), [1.0, math.nan], equal_nan=True
    )


def test_missing_values_pass_where_they_may():
    for values in ([1.0, math.nan], np.array([1.0, math.nan])):
        array = limits.FETCH.check_array("x", values, missing=True)
        assert np.array_equal(array, [1.0, math.nan], equal_nan=True)
    coordinates = [[math.nan, math.inf], [-math.inf, 1e308]]
    array = limits.COORDINATE.check_array("x", np.array(coordinates), missing=True)
    assert np.array_equal(array, coordinates, equal_nan=True)
    assert refusal([math.nan, 0.0], missing=True) == "x[1] must be between 1 and 5e+07 m, got 0.0"


def test_the_number_of_dimensions_is_held():
    list_of, table_of = "x must be a list of numbers", "x must be a table of numbers"
    assert refusal(3.0, ndim=1) == f"{list_of} between 1 and 5e+07 m, got 3.0 (float)"
    assert (
        refusal([[3.0]], ndim=1) == f"{list_of} between 1 and 5e+07 m, got [[3.0]] of shape (1, 1)"
    )
    assert refusal([3.0], ndim=2) == f"{table_of} between 1 and 5e+07 m, got [3.0] of shape (1,)"
    assert refusal("rough", ndim=1) == f"{list_of} between 1 and 5e+07 m, got 'rough' (str)"
    assert refusal(None, ndim=2) == f"{table_of} between 1 and 5e+07 m, got None (NoneType)"
    assert refusal(np.array(3.0), ndim=1).endswith("got array(3.) of shape ()")
    assert limits.FETCH.check_array("x", [[3.0]], ndim=2).shape == (1, 1)


def test_the_number_of_entries_is_held():
    assert refusal([1.0], least=2) == "x must be at least 2 numbers, got 1"
    assert refusal([1.0] * 5, least=2, most=4) == "x must be 2 to 4 numbers, got more"
    assert refusal([1.0], least=2, most=4) == "x must be 2 to 4 numbers, got 1"
    assert refusal(np.ones(5), most=4) == "x must be 0 to 4 numbers, got more"
    assert refusal(itertools.repeat(1.0), most=4) == "x must be 0 to 4 numbers, got more"
    assert limits.FETCH.check_array("x", [1.0] * 4, least=4, most=4).size == 4


def test_entries_ascend_strictly_along_the_last_dimension():
    for values in ([1.0, 3.0, 2.0], np.array([[1.0, 2.0, 3.0], [1.0, 3.0, 2.0]])):
        assert refusal(values, ascending=True) == (
            "x must be strictly ascending, got 3.0 m before 2.0 m"
        )
    assert refusal([2.0, 2.0], ascending=True).endswith("got 2.0 m before 2.0 m")
    for values in (5.0, [], [5.0], [[4.0, 5.0], [1.0, 2.0]]):
        limits.FETCH.check_array("x", values, ascending=True)


def test_arrays_of_counts_are_whole():
    assert limits.SAMPLES.check_array("n", np.array([1, 2], np.int16)).tolist() == [1.0, 2.0]
    assert refusal([1, 2.0], limits.SAMPLES) == (
        "x[1] must be a whole number between 1 and 65536, got 2.0 (float)"
    )
    assert refusal(np.array([1.0]), limits.SAMPLES) == (
        "x must be whole numbers between 1 and 65536, got array([1.]) (float64)"
    )
    assert refusal(np.array([0]), limits.SAMPLES).startswith("x[0] must be a whole number between")


# Every physical key of every constructor

SYSTEM = WaveSystem(spectrum=JONSWAP(peak=0.75), spreading=CosinePower(s=4.0))


def table(*, frequency: float = 0.125, density: float = 2.0) -> TabulatedSpectrum:
    return TabulatedSpectrum([0.0625, frequency, 0.25], [0.0, density, 1.0])


CONSTRUCTORS = {
    "PiersonMoskowitz": (PiersonMoskowitz, {"peak": 0.75, "alpha": 0.0078125}),
    "PiersonMoskowitz.from_wind": (PiersonMoskowitz.from_wind, {"speed": 14.0}),
    "PiersonMoskowitz.from_sea_state": (PiersonMoskowitz.from_sea_state, {"hs": 3.0, "tp": 9.0}),
    "JONSWAP": (JONSWAP, {"peak": 0.75, "alpha": 0.0078125, "gamma": 3.0}),
    "JONSWAP.from_wind": (JONSWAP.from_wind, {"speed": 14.0, "fetch": 2e5, "gamma": 3.0}),
    "JONSWAP.from_sea_state": (JONSWAP.from_sea_state, {"hs": 3.0, "tp": 9.0, "gamma": 3.0}),
    "TMA": (lambda depth: TMA(JONSWAP(peak=0.75), depth), {"depth": 40.0}),
    "TMA.from_sea_state": (TMA.from_sea_state, {"hs": 3.0, "tp": 9.0, "depth": 40.0, "gamma": 3.0}),
    "CustomSpectrum": (
        lambda peak: CustomSpectrum(lambda w: np.exp(-w), peak=peak),
        {"peak": 0.75},
    ),
    "TabulatedSpectrum": (table, {"frequency": 0.125, "density": 2.0}),
    "CosinePower": (CosinePower, {"s": 4.0}),
    "Blend": (Blend, {"weight": 0.25}),
    "WaveSystem": (
        lambda direction: WaveSystem(spectrum=JONSWAP(peak=0.75), direction=direction),
        {"direction": 30.0},
    ),
    "Sea": (lambda **water: Sea(SYSTEM, **water), {"depth": 40.0, "surface_tension": 0.0625}),
    "Sea.from_wind": (
        Sea.from_wind,
        {"speed": 14.0, "fetch": 2e5, "depth": 40.0, "direction": 30.0, "gamma": 3.0},
    ),
    "from_compass": (from_compass, {"bearing": 225.0}),
}
KEYS = [(name, key) for name, (_, valid) in CONSTRUCTORS.items() for key in valid]
BAD = [math.nan, math.inf, -math.inf, -1.0, 0.0, "5", True, None, 1e308, 1e-308]
REFUSED_EVERYWHERE = (math.nan, -math.inf, "5", True, None)
# None: taken from the sea's spectra; from the height and the period
UNSTATED = {("Sea", "depth"), ("Sea", "surface_tension")}
UNSTATED |= {("JONSWAP.from_sea_state", "gamma"), ("TMA.from_sea_state", "gamma")}


def build(name: str, key: str, value: object) -> np.ndarray:
    """
    Make it with one value changed, and look at it: everything it says from a thousandth of its peak
    to a thousand times it.
    """
    make, valid = CONSTRUCTORS[name]
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore", SeaWarning
        )  # still air may say so; any other warning is an error
        thing = make(**{**valid, key: value})
    theta = np.linspace(-7.0, 7.0, 15)
    steps = np.geomspace(1e-3, 1e3, 121)
    if isinstance(thing, float):
        return np.array([thing])
    if isinstance(thing, WaveSystem):
        return thing.density((thing.spectrum.peak * steps)[:, None], theta)
    if isinstance(thing, CosinePower | Blend):
        return thing(steps[:, None], theta, 1.0)
    if isinstance(thing, Sea):
        return np.concatenate(
            [thing(thing.peak * steps), thing.density((thing.peak * steps)[:, None], theta).ravel()]
        )
    return thing(thing.peak * steps)


@pytest.mark.parametrize("value", BAD, ids=repr)
@pytest.mark.parametrize(("name", "key"), KEYS)
def test_a_clean_refusal_or_a_finite_sea(name, key, value):
    try:
        said = build(name, key, value)
    except ParameterError as error:
        message = str(error)
        assert re.search(rf"\b{key}\b.* must ", message), message  # the key and the rule
        shown = (
            {repr(value), repr(float(value))}
            if isinstance(value, float)
            else {f"{value!r} ({type(value).__name__})"}
        )
        assert any(message.endswith(f"got {text}") for text in shown), message  # and what came
    else:
        assert np.all((said >= 0.0) & (said < math.inf))
        unstated = value is None and (name, key) in UNSTATED
        assert unstated or not any(value is bad for bad in REFUSED_EVERYWHERE)


def test_exactly_these_odd_values_are_let_through():
    """The sweep above would pass if everything were refused; this is what is not."""
    through = set()
    for name, key in KEYS:
        for value in BAD:
            try:
                build(name, key, value)
            except ParameterError:
                continue
            through.add((key, value))
    assert through == {
        *(
            (key, value)
            for key in ("hs", "alpha", "s", "weight", "density", "surface_tension", "speed")
            for value in (0.0, 1e-308)
        ),
        *((key, value) for key in ("direction", "bearing") for value in (-1.0, 0.0, 1e-308)),
        *(("depth", value) for value in (math.inf, 1e308)),
        *((key, None) for _, key in UNSTATED),
    }


@pytest.mark.parametrize(("name", "key"), KEYS)
def test_numpy_numbers_are_numbers(name, key):
    """
    The valid values are all exact in single precision: the sea must be the same to the bit,
    whatever they came as.
    """
    value = CONSTRUCTORS[name][1][key]
    expected = build(name, key, value)
    kinds = [np.float64, np.float32, Fraction, *([int, np.int64] if value.is_integer() else [])]
    for kind in (
        kinds if name != "TMA.from_sea_state" else [np.float32]
    ):  # its quadrature takes a quarter of a second
        assert np.array_equal(build(name, key, kind(value)), expected), kind
    for bad in (np.array(value), np.True_, Decimal(value), complex(value)):
        with pytest.raises(ParameterError, match=rf"\b{key}\b.* must be a number "):
            build(name, key, bad)


def test_stored_values_are_plain_floats():
    """
    A spectrum made from single precision is not computed in it, and integers are not raised to
    integer powers.
    """
    for thing in (
        JONSWAP(peak=np.float32(0.7), alpha=np.float16(0.01), gamma=np.int64(2)),
        PiersonMoskowitz(peak=2, alpha=1),
    ):
        assert all(type(getattr(thing, name)) is float for name in thing.__slots__)
    turned = WaveSystem(spectrum=SYSTEM.spectrum, direction=np.int8(3))
    stored = [
        TMA(SYSTEM.spectrum, np.int32(4)).depth,
        CosinePower(s=4).s,
        Blend(weight=1).weight,
        turned.direction,
        Sea(depth=4).depth,
    ]
    assert {type(value) for value in stored} == {float}
    assert PiersonMoskowitz(peak=np.int64(2)) == PiersonMoskowitz(peak=2.0)
    assert (
        repr(PiersonMoskowitz(peak=np.float64(2.0))) == "PiersonMoskowitz(peak=2.0, alpha=0.0081)"
    )


# The floor that limits stands on


def test_what_can_go_wrong_is_one_tree():
    tree = {
        kind: kind.exit_code
        for kind in vars(errors).values()
        if isinstance(kind, type) and issubclass(kind, errors.FFTOceanError)
    }
    assert tree == {
        errors.FFTOceanError: 2,
        errors.ParameterError: 2,
        errors.JobError: 2,
        errors.ReaderError: 3,
        errors.FieldError: 2,
        errors.OutputError: 4,
        errors.FolderInUseError: 6,
        errors.IntegrityError: 5,
        errors.DeviceError: 2,
    }
    for kind in (errors.ParameterError, errors.JobError, errors.ReaderError):
        assert issubclass(kind, ValueError)
    assert issubclass(errors.FieldError, AttributeError)
    assert issubclass(errors.FolderInUseError, errors.OutputError)
    assert issubclass(errors.OutputError, OSError)


def test_memory_is_asked_for_before_it_is_taken():
    assert host.available_memory() > 0.0
    host.require_memory("a small thing", 1.0)
    with pytest.raises(
        ParameterError,
        match=r"^a vast ocean needs about 1048576\.0 GiB of memory, but only \d+\.\d GiB are free$",
    ):
        host.require_memory("a vast ocean", 2.0**50)


def test_complex_types_have_the_parts_they_are_named_after():
    for real, whole in arrays.COMPLEX_OF.items():
        assert np.empty(1, whole).real.dtype == np.dtype(real)


def test_a_rule_names_whole_limits_with_all_digits():
    assert limits.Count("", 0, 2**32 - 1).rule == "between 0 and 4294967295"
    assert limits.Count("", 0, 10**6).rule == "between 0 and 1e+06"
