#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

/// Many runs on several threads, which one more thread waits for.
namespace clutchwork {

/// How far all threads are, and whether they shall stop.
class Course {
 public:
  std::atomic<std::int64_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;

  /// Asked by every run after every step.
  static int stopped(void* self) { return static_cast<Course*>(self)->stop.load(std::memory_order_relaxed) ? 1 : 0; }

  void leave(std::exception_ptr why) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (why) failure = why, stop = true;
    ++left_;
    changed_.notify_all();
  }

  /// Wait until so many threads have left, for a while at most. Whether they have.
  bool wait(int threads, std::chrono::milliseconds most) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, most, [&] { return left_ == threads; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int left_ = 0;
};

/// Call `work` with its number on each of so many threads; `pause` is called now and then by the thread that waits, and
/// stops them all by returning true. What a thread throws is thrown here.
template <class Pause, class Work>
void on_threads(int threads, Course& course, Pause&& pause, Work&& work) {
  std::vector<std::thread> running;
  int started = 0;
  auto begin = [&](int number) {
    std::exception_ptr failure;
    try {
      work(number);
    } catch (...) {
      failure = std::current_exception();
    }
    course.leave(failure);
  };
  try {
    for (; started < threads; ++started) running.emplace_back(begin, started);
  } catch (...) {
    // fewer threads do it too, none does not
    if (started == 0) throw;
  }
  while (!course.wait(started, std::chrono::milliseconds(50)))
    if (pause()) course.stop = true;
  for (std::thread& thread : running) thread.join();
  if (course.failure) std::rethrow_exception(course.failure);
}

}  // namespace clutchwork
