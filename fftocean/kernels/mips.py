"""One level of a mip chain from the one before."""

from fftocean.arrays import Real
from fftocean.kernels.compiler import compiled


@compiled
def halve(texels: Real, out: Real) -> None:
    """
    Write the means of texels over boxes, from n samples an axis to m = max(1, n // 2).

    Box i covers i n/m to (i + 1) n/m. Where n is odd a box ends within a sample, which is shared by
    length; so all samples have one weight, and means are kept. Both arrays are (rows, columns,
    channels).
    """
    rows, columns, channels = texels.shape
    tall, wide = out.shape[0], out.shape[1]
    for q in range(tall):
        first_row, last_row = q * rows / tall, (q + 1) * rows / tall
        for p in range(wide):
            first, last = p * columns / wide, (p + 1) * columns / wide
            for c in range(channels):
                out[q, p, c] = 0.0
            for j in range(int(first_row), rows):
                high = min(j + 1.0, last_row) - max(float(j), first_row)
                if high <= 0.0:
                    break
                for i in range(int(first), columns):
                    long = min(i + 1.0, last) - max(float(i), first)
                    if long <= 0.0:
                        break
                    share = high * long * (tall / rows) * (wide / columns)
                    for c in range(channels):
                        out[q, p, c] += share * texels[j, i, c]
