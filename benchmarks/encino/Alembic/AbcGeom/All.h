// The names of types that EncinoWaves takes from Alembic; the benchmark needs nothing else of it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include <ImathBox.h>
#include <ImathColor.h>
#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <ImathVec.h>
#include <half.h>

namespace Alembic {
namespace AbcGeom {
using namespace Imath;
using std::int16_t;
using std::int32_t;
using std::int64_t;
using std::int8_t;
using std::uint16_t;
using std::uint32_t;
using std::uint64_t;
using std::uint8_t;
typedef half float16_t;
typedef float float32_t;
typedef double float64_t;
typedef double chrono_t;
typedef bool bool_t;
typedef std::uint8_t byte_t;
typedef std::size_t index_t;
typedef V3f N3f;
typedef V3d N3d;
}  // namespace AbcGeom
namespace Util {}
}  // namespace Alembic
