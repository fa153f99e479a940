// SPDX-License-Identifier: Apache-2.0
// Streams of work on a device, events in them, and the check of every CUDA call.
//
// Each backend has streams of its own that do not wait for the legacy default stream. So several simulations can use
// one device at the same time from several threads.
#pragma once

#include <cuda_runtime_api.h>

#include "mercury/error.h"
#include "sim/cuda/failures.h"

namespace mercury::cuda {

// Throws DeviceError if a call failed. `what` says what the call was for.
inline void check(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  (void)cudaGetLastError();  // the next launch shall not report it again
  throw DeviceError(failure_text(error, what));
}

// A moment in a stream.
class Event {
 public:
  // Only `timed` and `sleepy` events know their time; the others cost less. A thread that waits for a `sleepy` event
  // lets others use its core, but notices the event some 50 us later.
  enum Kind : unsigned { untimed = cudaEventDisableTiming, timed = cudaEventDefault, sleepy = cudaEventBlockingSync };

  explicit Event(Kind kind = untimed) { check(cudaEventCreateWithFlags(&event_, kind), "creating an event"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void record(cudaStream_t stream) { check(cudaEventRecord(event_, stream), "recording an event"); }
  void synchronize() const { check(cudaEventSynchronize(event_), "stepping"); }
  // What follows in the stream begins after this event.
  void hold(cudaStream_t stream) const { check(cudaStreamWaitEvent(stream, event_, 0), "ordering streams"); }
  // The time from `start` to this event [s]. Waits for this event.
  double seconds_since(const Event& start) const {
    synchronize();
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "reading events");
    return static_cast<double>(milliseconds) * 1e-3;
  }
  cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

// No other stream has the same one, not even later.
inline unsigned long long id_of(cudaStream_t stream) {
  unsigned long long id = 0;
  check(cudaStreamGetId(stream, &id), "naming a stream");
  return id;
}

class Stream {
 public:
  // What an `urgent` stream does comes before what waits in other streams: short work beside the steps of others.
  explicit Stream(bool urgent = false) {
    int least = 0, greatest = 0;
    check(cudaDeviceGetStreamPriorityRange(&least, &greatest), "creating a stream");
    check(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, urgent ? greatest : least),
          "creating a stream");
  }
  ~Stream() { cudaStreamDestroy(stream_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  cudaStream_t get() const { return stream_; }
  void synchronize() const { check(cudaStreamSynchronize(stream_), "waiting for the device"); }
  // What follows in this stream begins after the event.
  void wait_for(const Event& event) const { event.hold(stream_); }

 private:
  cudaStream_t stream_ = nullptr;
};

}  // namespace mercury::cuda
