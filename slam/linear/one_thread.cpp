#include "slam/linear/one_thread.hpp"

// Of libgomp, which CHOLMOD is linked with. Not from omp.h: another compiler's is that of another
// library.
extern "C" {
int omp_get_max_active_levels();
void omp_set_max_active_levels(int);
}

namespace corridor::linear {

// Of the calling thread alone.
OneThread::OneThread() : levels_before_(omp_get_max_active_levels()) {
  omp_set_max_active_levels(0);
}

OneThread::~OneThread() { omp_set_max_active_levels(levels_before_); }

}  // namespace corridor::linear
