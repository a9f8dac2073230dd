"""Number of frames from a frame rate."""

import builders
import pytest

import fftocean as fo
from fftocean.job.frame_rate import with_frame_rate


@pytest.mark.parametrize(
    ("fps", "loop", "frames"),
    [(30.0, 16.0, 480), (24.0, 2.5, 60), (0.25, 16.0, 4), (29.97, 100.0, 2997)],
)
def test_frames_are_the_loop_times_the_rate(fps, loop, frames):
    job = builders.job({"ocean.loop": loop})
    assert with_frame_rate(job, fps).frames == frames


@pytest.mark.parametrize("fps", [0.0, -1.0, float("nan"), float("inf")])
def test_a_rate_that_is_not_positive_and_finite_is_refused(fps):
    with pytest.raises(fo.JobError, match=f"fps must be positive and finite, got {fps:g}"):
        with_frame_rate(fo.Job.default(), fps)


@pytest.mark.parametrize("fps", [7.01, 1e300, 1e-9, 1e-300])
def test_a_rate_without_a_whole_number_of_frames_is_refused(fps):
    """The message names a loop that has one."""
    with pytest.raises(fo.JobError, match=r"a whole number of frames, got .* need a loop of "):
        with_frame_rate(fo.Job.default(), fps)
