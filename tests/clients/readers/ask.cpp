// Answers the questions of ask.txt by sea_waves.hpp: see tests/clients/sea_waves.py.
#include "sea_waves.hpp"

#include <cstdio>
#include <memory>

int main() {
    std::unique_ptr<fftocean::SeaWaves> sea;
    std::ifstream file("ask.txt");
    for (std::string word; file >> word;) {
        if (word == "sea") {
            std::string folder;
            long strongest;
            file >> folder >> strongest;
            try {
                if (strongest < 0) sea = std::make_unique<fftocean::SeaWaves>(folder);
                else sea = std::make_unique<fftocean::SeaWaves>(folder, std::size_t(strongest));
                std::printf("ok %.17g\n", sea->neglected_rms);
            } catch (const fftocean::SeaError& error) {
                std::printf("error %s\n", error.what());
            }
            continue;
        }
        double x, y, t;
        file >> x >> y >> t;
        const fftocean::Water w = word == "at" ? sea->at(x, y, t) : sea->rest(x, y, t);
        const double all[] = {w.x0, w.y0, w.x, w.y, w.height, w.normal[0], w.normal[1], w.normal[2],
            w.residual, w.jacobian};
        for (double value : all) std::printf("%.17g ", value);
        std::printf("\n");
    }
}
