#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

/// Many runs on several threads, of which the caller is one.
namespace clutchwork {

/// How far all threads are, and whether they shall stop.
class Course {
 public:
  std::atomic<std::int64_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::exception_ptr failure;

  /// Asked by every run after every step.
  static int stopped(void* self) {
    auto& course = *static_cast<Course*>(self);
    if (std::this_thread::get_id() == course.here_ && --course.left_out_ < 0) course.listen();
    return course.stop.load(std::memory_order_relaxed) ? 1 : 0;
  }

  /// The calling thread works, too; `pause` is called by it now and then.
  void join(std::function<bool()> pause) { pause_ = std::move(pause), here_ = std::this_thread::get_id(); }

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
  using Clock = std::chrono::steady_clock;
  std::thread::id here_;
  std::function<bool()> pause_;
  Clock::time_point listened_ = Clock::now();
  int left_out_ = 0;

  /// Looks at the clock every few steps, and listens every 50 ms.
  void listen() {
    left_out_ = 16;
    const auto now = Clock::now();
    if (now - listened_ < std::chrono::milliseconds(50)) return;
    listened_ = now;
    if (pause_()) stop = true;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  int left_ = 0;
};

/// Call `work` with its number on each of so many threads, the calling one with 0; `pause` is called now and then by
/// that one, and stops them all by returning true. What a thread throws is thrown here.
template <class Pause, class Work>
void on_threads(int threads, Course& course, Pause&& pause, Work&& work) {
  std::vector<std::thread> running;
  int started = 1;
  auto begin = [&](int number) {
    std::exception_ptr failure;
    try {
      work(number);
    } catch (...) {
      failure = std::current_exception();
    }
    course.leave(failure);
  };
  course.join(pause);
  try {
    for (; started < threads; ++started) running.emplace_back(begin, started);
  } catch (...) {
    // fewer threads do it too
  }
  begin(0);
  while (!course.wait(started, std::chrono::milliseconds(50)))
    if (pause()) course.stop = true;
  for (std::thread& thread : running) thread.join();
  if (course.failure) std::rethrow_exception(course.failure);
}

}  // namespace clutchwork
