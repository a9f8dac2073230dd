// oneTBB has no mutex of its own any more.
#pragma once
#include <mutex>

namespace tbb {
typedef std::mutex mutex;
}
