// SPDX-License-Identifier: Apache-2.0
// A thread that draws for the other threads of a program.
//
// An OpenGL context belongs to one thread at a time, while the threads of a program (of Python, say) come and go. So
// the context and its renderer live on a thread of their own, and callers queue what they want drawn:
//
//   thread A   picture_of()        --\.
//   thread B   Film::add_frame()   ----> tasks --> drawing thread: one context, one renderer
//   thread C   film_of()           --/.
//
// 1. The thread, the context and the shaders are made by the first task, and used by all later ones.
// 2. Tasks run one after another, in the order of their calls. A task finds the renderer with the size, the quality
//    and the bodies of the task before, and sets its own.
// 3. A fork() copies the memory but not the thread. In the child, every call throws DeviceError, and nothing waits for
//    a thread that is not there. A child that begins to draw before its parent has is fine. The child has to end by
//    _exit(): handlers of NVIDIA's driver that run at a normal exit take the GPU away from the parent's context.
#pragma once

#include <functional>
#include <future>
#include <memory>

#include "app/video/video_pipeline.h"

namespace mercury {

class DrawingThread {
 public:
  // What a task works with.
  struct Canvas {
    OffscreenRenderer offscreen;
    std::shared_ptr<const void> owner;  // of the bodies that the renderer has; whoever sets bodies sets it
  };
  using Task = std::function<void(Canvas&)>;

  // Does not start the thread.
  explicit DrawingThread(render::ContextKind kind = render::ContextKind::automatic);
  ~DrawingThread();  // waits for the tasks that are queued
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  // Waits for the tasks that are queued, and gives the context back. post() throws DeviceError afterward.
  void end();

  // Queues a task. The future passes on what it throws, and render::ContextError if there is no OpenGL here. Throws
  // DeviceError in a process that was forked from one that has drawn. Every thread may call it, except in a task.
  std::future<void> post(Task task);

  // Throws that DeviceError. To be called before what would wait for other threads that are not in a forked process
  // either, such as those that measure robots.
  void require_no_fork() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
