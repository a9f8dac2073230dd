// EncinoWaves behind four functions in C: one sea of 2^power samples a side, its frames and fields.
//
// Its FFTs are planned with MEASURE instead of ESTIMATE, as those of its competitor are.
#include <fftw3.h>
#undef FFTW_ESTIMATE
#define FFTW_ESTIMATE FFTW_MEASURE

#include <EncinoWaves/All.h>
#include <tbb/global_control.h>

namespace ew = EncinoWaves;

struct Sea {
    tbb::global_control threads;
    ew::Parametersf parameters;
    ew::InitialStatef start;
    ew::Propagationf propagation;
    ew::PropagatedStatef now;
    std::vector<Imath::V3f> normals;

    Sea(const ew::Parametersf& p, int count)
        : threads(tbb::global_control::max_allowed_parallelism, count), parameters(p), start(p),
          propagation(p, count), now(p), normals(now.Height.size()) {}
};

extern "C" void* sea_new(int power, int threads) {
    ew::Parametersf parameters;
    parameters.resolutionPowerOfTwo = power;
    parameters.domain = 100.0f;
    parameters.troughDamping = 0;  // else it computes some fields twice
    return new Sea(parameters, threads);
}

extern "C" void sea_free(void* sea) { delete static_cast<Sea*>(sea); }

extern "C" void sea_frame(void* sea, float t) {
    Sea& s = *static_cast<Sea*>(sea);
    s.propagation.propagate(s.parameters, s.start, s.now, t);
    ew::ComputeNormals<float>(s.parameters, s.now, s.normals.data());
}

// 0 height, 1 and 2 displacements, 3 least eigenvalue, 4 normals; rows have one sample more
extern "C" const float* sea_field(void* sea, int number) {
    Sea& s = *static_cast<Sea*>(sea);
    switch (number) {
        case 0: return s.now.Height.cdata();
        case 1: return s.now.Dx.cdata();
        case 2: return s.now.Dy.cdata();
        case 3: return s.now.MinE.cdata();
        default: return &s.normals[0].x;
    }
}
