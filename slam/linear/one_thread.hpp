// Keeps what is called from here on one thread: CHOLMOD's supernodal code opens OpenMP regions of
// four threads whatever the environment says, and on pose graphs their waiting costs more than they
// save (city10000: 44 ms instead of 26).
#pragma once

namespace corridor::linear {

class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_before_;
};

}  // namespace corridor::linear
