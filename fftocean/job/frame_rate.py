"""Number of frames of a job from a frame rate."""

import math

from fftocean.errors import JobError
from fftocean.job.job import Job

_MOST_FRAMES = 10**9


def with_frame_rate(job: Job, fps: float) -> Job:
    """
    Return a job with as many frames as its loop has at a frame rate.

    Args:
        job: any job.
        fps: frames a second [1/s].

    Raises:
        JobError: `fps` is not positive and finite, or the loop has no whole number of frames.
    """
    if not (math.isfinite(fps) and fps > 0.0):
        raise JobError(f"fps must be positive and finite, got {fps:g}")
    loop = job.settings["ocean.loop"]
    product = loop * fps
    frames = round(product) if product < _MOST_FRAMES else 0
    if frames < 1 or abs(product - frames) > 1e-6 * frames:
        near = max(1, min(round(product), _MOST_FRAMES)) if math.isfinite(product) else 1
        raise JobError(
            f"fps must give the loop a whole number of frames, got {product:.6g} for {loop:g} s "
            f"at {fps:g} a second; {near} frames need a loop of {near / fps:.6g} s"
        )
    return job.replaced({"bake.frames": frames})
