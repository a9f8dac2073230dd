// Writes what SeaLayout.h makes of a package: its arrays as the kernels take them.
#include "SeaLayout.h"

template <typename T> void Write(const char* name, const std::vector<T>& data) {
    std::ofstream file(name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(data.data()), std::streamsize(data.size() * sizeof(T)));
}

int main(int, char** arguments) {
    const fftocean::SeaWaves sea{std::string(arguments[1])};
    const FSeaLayout layout(sea);
    Write("h0", layout.H0);
    Write("wave", layout.Wave);
    Write("twiddle", layout.Twiddle);
    Write("tiles", layout.Tiles);
    std::printf("%u %u %u\n", layout.Texels, layout.MapTexels, layout.Groups);
}
