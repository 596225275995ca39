#pragma once
#include <clutchwork/c_api.h>
#include <clutchwork/layout.gen.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "threads.hpp"

/// Many runs that go on side by side, each up to an end of its own. docs/guide/stepping.md
namespace clutchwork::many {

/// Runs that one thread takes at once, where there are many.
constexpr std::int64_t most_at_once = 16;

/// Consecutive runs, of which threads take some after others.
struct Part {
  std::int64_t first, last;
  alignas(64) std::atomic<std::int64_t> taken{0};
};

struct Member {
  cw_run* run;
  std::int64_t number;  ///< which it is: of its row, its status, its events
};

/// Values of one signal that wait for the next step of each run; NaN: none does.
struct Waiting {
  std::int64_t input;
  std::vector<double> values;

  /// Give a run its value. False: it is refused.
  bool give(cw_run* run, std::int64_t number) {
    double& value = values[std::size_t(number)];
    const bool taken = std::isnan(value) || cw_set_input(run, input, value);
    value = __builtin_nan("");
    return taken;
  }
};

/// What is to be done, and where results go; each run is one thread's.
struct Task {
  std::vector<Member> members;
  const double* ends;  ///< of each number [s]
  double* rows;        ///< of each number, at its end
  std::int64_t row_size;
  std::int32_t* status;
  std::vector<Waiting>* waiting;
  bool backward;  ///< the last ones go first
};

/// Numbers of an event, after the number of its run.
inline std::int64_t event_kept() { return 1 + cw_event_size(); }

/// One run to its end, with the row there; its events follow those that were found before.
inline int advance(const Task& task, const Member& member, std::vector<double>& events) {
  for (Waiting& one : *task.waiting) {
    if (!one.give(member.run, member.number)) return -1;
  }
  double time = task.ends[member.number], *row = task.rows + member.number * task.row_size;
  std::int64_t filled = 0, more = 0;
  int status;
  do {
    status = cw_advance(member.run, time, &time, row, 1 - filled, 0, &more);
    filled += more;
    const std::int64_t n = cw_pending_events(member.run), size = cw_event_size();
    for (std::int64_t i = 0; i < n; ++i) {
      const std::size_t at = events.size();
      events.resize(at + std::size_t(1 + size));
      events[at] = double(member.number);
      cw_take_events(member.run, events.data() + at + 1, 1);
    }
  } while (status == int(Status::events_full));
  return status;
}

/// All of them on so many threads; the events of each thread. A thread begins with its own part, the same in every
/// call, and helps others behind it: most of what it reads is near its processor still.
template <class Pause>
std::vector<std::vector<double>> advance_all(const Task& task, int threads, Course& course, Pause&& pause) {
  const auto count = std::int64_t(task.members.size());
  threads = int(std::clamp<std::int64_t>(count, 1, threads));
  const std::int64_t chunk = std::clamp<std::int64_t>(count / (4 * threads), 1, most_at_once);
  std::vector<std::vector<double>> events(std::size_t(threads), std::vector<double>{});
  const std::unique_ptr<Part[]> parts(new Part[std::size_t(threads)]);
  for (int k = 0; k < threads; ++k) parts[k].first = k * count / threads, parts[k].last = (k + 1) * count / threads;
  on_threads(threads, course, pause, [&](int number) {
    for (int k = 0; k < threads; ++k) {
      Part& part = parts[(number + k) % threads];
      const std::int64_t size = part.last - part.first;
      for (std::int64_t begin; !course.stop && (begin = part.taken.fetch_add(chunk)) < size;) {
        for (std::int64_t i = begin; i < std::min(begin + chunk, size) && !course.stop; ++i) {
          const Member& member = task.members[std::size_t(task.backward ? part.last - 1 - i : part.first + i)];
          cw_set_poll(member.run, &Course::stopped, &course);
          task.status[member.number] = advance(task, member, events[std::size_t(number)]);
          cw_set_poll(member.run, nullptr, nullptr);
        }
      }
    }
  });
  return events;
}

}  // namespace clutchwork::many
