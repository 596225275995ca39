#pragma once
#include <clutchwork/c_api.h>
#include <clutchwork/layout.gen.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "threads.hpp"

/// Many runs of one driveline with other numbers, on several threads. docs/guide/sweeps.md
namespace clutchwork::sweep {

/// Words of eight bytes of a system that change together, and what they are for each value.
struct Axis {
  const std::int64_t* place;   ///< of each word
  const std::uint64_t* words;  ///< a line of them for each value
  std::int64_t count, values;
};

struct Bytes {
  const char* data;
  std::int64_t size;
};

/// What is to be done, shared by all threads.
struct Task {
  std::vector<Bytes> systems;
  std::vector<Axis> axes;
  std::vector<std::pair<std::string, double>> options;
  const std::int64_t* choice;  ///< a line for each variant: its system, then its value of each axis
  std::int64_t variants;
  double t_end;
  const double* times;  ///< instants of a grid
  std::int64_t instants;
  int parts;                         ///< rows in every step, 0: the grid
  const std::int64_t* columns;       ///< numbers of a row that are kept
  std::int64_t width;                ///< how many
  bool events;                       ///< whether they are kept
  bool chosen;                       ///< whether runs are told what is read of rows
  std::vector<std::int64_t> inside;  ///< those of rows inside of steps: cw_read
};

/// Numbers that tell why a run stopped: component, time, value, number of the row.
constexpr std::int64_t detail_size = 4;
/// Numbers kept of an event: variant, time, contact, mode before and after.
constexpr std::int64_t event_kept = 5;
/// Consecutive variants that one thread takes at once.
constexpr std::int64_t group = 8;

/// What comes of each variant, written by the thread that has it; nothing here grows.
struct Results {
  std::int32_t* status;
  double* detail;
  double* grid;  ///< variants x instants x width
};

/// What one thread found, in the order in which it ran them.
struct Found {
  std::vector<std::int64_t> variant, rows;  ///< variants and how many rows each has
  std::vector<double> times, values, events;
  std::vector<double> ends;  ///< what is kept of the first and the last row of each
};

/// One thread: its memory, and the variants it takes.
class Worker {
 public:
  Worker(const Task& task, const Results& results, Course& course)
      : task_(task), results_(results), course_(course), event_(std::size_t(cw_event_size()) * event_room) {}

  /// Take groups of variants until none is left.
  void work() {
    while (!course_.stop) {
      const std::int64_t first = course_.next.fetch_add(group);
      if (first >= task_.variants) return;
      const std::int64_t last = first + group < task_.variants ? first + group : task_.variants;
      run_group(first, last);
      course_.done += last - first;
    }
  }

  Found found;

 private:
  static constexpr std::int64_t event_room = 256;
  // rows in steps before they are taken away: a group goes on together the longer the more there are
  static constexpr std::int64_t least_rows = 256, most_rows = 1024, most_numbers = 100'000;

  struct alignas(64) Block {
    unsigned char byte[64];
  };

  const Task& task_;
  const Results& results_;
  Course& course_;
  /// Memory that grows to the largest size that is asked for.
  struct Memory {
    std::unique_ptr<Block[]> block;
    std::int64_t bytes = 0;

    void* of(std::int64_t size) {
      if (size > bytes) block = std::make_unique<Block[]>(std::size_t(size + 63) / 64), bytes = (size + 63) / 64 * 64;
      return block.get();
    }
  };

  /// One variant of a group: its system, its run, its rows.
  struct Place {
    std::int64_t base = -1, size = 0, needed = 0, row_size = 0;
    std::vector<std::uint64_t> system;  ///< bytes of the variant
    std::vector<std::int64_t> value;    ///< of each axis that these bytes have
    Memory memory;
    std::vector<double> times, rows;
    std::vector<double> kept_times, kept, ends;  ///< of the rows in steps up to now
    cw_run* run = nullptr;
  };
  Place place_[group];
  Memory together_;
  std::vector<double> event_;

  /// Consecutive variants, whose steps are taken together.
  void run_group(std::int64_t first, std::int64_t last) {
    cw_member members[group];
    std::int64_t of[group], n = 0, size = 0;
    for (std::int64_t v = first; v < last; ++v) {
      Place& p = place_[v - first];
      if (!prepare(p, v)) continue;
      const std::int64_t rows = std::int64_t(p.times.size());
      members[n] = {p.run, p.times.data(), p.rows.data(), rows, task_.parts, int(Status::rows_full), 0};
      size = std::max(size, cw_group_size(p.run));
      of[n++] = v;
    }
    void* memory = together_.of(size);
    cw_advance_group(members, n, task_.t_end, memory, size);
    if (task_.parts > 0) record_steps(members, of, n, first, memory, size);
    for (std::int64_t i = 0; i < n && !course_.stop; ++i) {
      Place& p = place_[of[i] - first];
      const int status = task_.parts > 0 ? close_steps(p, of[i], members[i]) : record_grid(p, of[i], members[i]);
      if (status != int(Status::done)) tell(p, of[i], status);
      results_.status[of[i]] = status;
    }
  }

  /// A variant ready to run; false: the core does not take it.
  bool prepare(Place& p, std::int64_t v) {
    load(p, v);
    if (p.run == nullptr) {
      results_.status[v] = int(Status::bad_system);
      return false;
    }
    for (const auto& [name, value] : task_.options) cw_set_option(p.run, name.c_str(), value);
    if (task_.chosen)
      cw_read(p.run, task_.columns, task_.width, task_.inside.data(), std::int64_t(task_.inside.size()));
    cw_set_poll(p.run, &Course::stopped, &course_);
    for (std::int64_t i = 0; i < task_.instants && task_.parts == 0; ++i) p.times[std::size_t(i)] = task_.times[i];
    return true;
  }

  // ------------------------------------------------------------------------------------------------------------- load

  void load(Place& p, std::int64_t v) {
    const std::int64_t* choice = task_.choice + v * (1 + std::int64_t(task_.axes.size()));
    if (choice[0] != p.base) take_base(p, choice[0]);
    for (std::size_t a = 0; a < task_.axes.size(); ++a) {
      const std::int64_t value = choice[1 + a];
      if (value == p.value[a]) continue;
      const Axis& axis = task_.axes[a];
      for (std::int64_t k = 0; k < axis.count; ++k)
        p.system[std::size_t(axis.place[k])] = axis.words[value * axis.count + k];
      p.value[a] = value;
    }
    p.run = cw_load(p.system.data(), p.size, p.memory.of(p.needed), p.needed);
    if (p.run != nullptr && cw_row_size(p.run) != p.row_size) make_room(p, cw_row_size(p.run));
  }

  void take_base(Place& p, std::int64_t base) {
    const Bytes& bytes = task_.systems[std::size_t(base)];
    p.system.resize(std::size_t(bytes.size + 7) / 8);
    std::memcpy(p.system.data(), bytes.data, std::size_t(bytes.size));
    p.base = base, p.size = bytes.size, p.needed = cw_size(bytes.data, bytes.size);
    p.value.assign(task_.axes.size(), -1);
  }

  void make_room(Place& p, std::int64_t row_size) {
    p.row_size = row_size;
    const std::int64_t rows =
        task_.parts > 0
            ? task_.parts + std::clamp(most_numbers / std::max(row_size, std::int64_t(1)), least_rows, most_rows)
            : task_.instants;
    p.times.resize(std::size_t(rows));
    p.rows.resize(std::size_t(rows * row_size));
  }

  // ---------------------------------------------------------------------------------------------------------- collect

  static bool goes_on(int status) { return status == int(Status::rows_full) || status == int(Status::events_full); }

  /// What a group has found of a variant; what had no room there goes on alone.
  int record_grid(Place& p, std::int64_t v, const cw_member& member) {
    std::int64_t filled = member.filled, more = 0;
    int status = member.status;
    take_events(p.run, v);
    while (goes_on(status)) {
      status = cw_advance(p.run, task_.t_end, p.times.data() + filled, p.rows.data() + filled * p.row_size,
                          task_.instants - filled, 0, &more);
      filled += more;
      take_events(p.run, v);
    }
    double* out = results_.grid + v * task_.instants * task_.width;
    for (std::int64_t i = 0; i < filled; ++i) keep(p.rows.data() + i * p.row_size, out + i * task_.width);
    return status;
  }

  /// Rows in steps of a group that has been advanced: those of all are taken away, and who has more goes on.
  void record_steps(cw_member* members, const std::int64_t* of, std::int64_t n, std::int64_t first, void* memory,
                    std::int64_t size) {
    cw_member more[group];
    std::int64_t who[group], left = 0;
    for (std::int64_t i = 0; i < n; ++i) who[left] = i, more[left++] = members[i];
    while (left > 0) {
      std::int64_t on = 0;
      for (std::int64_t i = 0; i < left; ++i) {
        take_steps(place_[of[who[i]] - first], of[who[i]], more[i].filled);
        members[who[i]] = more[i];
        if (goes_on(more[i].status)) who[on] = who[i], more[on++] = more[i];
      }
      left = on;
      if (left > 0) cw_advance_group(more, left, task_.t_end, memory, size);
    }
  }
  void take_steps(Place& p, std::int64_t v, std::int64_t filled) {
    const auto wide = std::size_t(task_.width), inside = task_.inside.size();
    if (p.kept_times.empty() && filled > 0) p.ends.assign(2 * wide, 0.0), keep(p.rows.data(), p.ends.data());
    if (filled > 0) keep(p.rows.data() + (filled - 1) * p.row_size, p.ends.data() + wide);
    double* to = grown(p.kept, std::size_t(filled) * inside);
    for (std::int64_t i = 0; i < filled; ++i) {
      for (std::size_t c = 0; c < inside; ++c) *to++ = p.rows[std::size_t(i * p.row_size + task_.inside[c])];
    }
    p.kept_times.insert(p.kept_times.end(), p.times.begin(), p.times.begin() + filled);
    take_events(p.run, v);
  }
  static double* grown(std::vector<double>& numbers, std::size_t by) {
    numbers.resize(numbers.size() + by);
    return numbers.data() + numbers.size() - by;
  }
  /// The rows of a variant, behind those of the variants before it.
  int close_steps(Place& p, std::int64_t v, const cw_member& member) {
    found.variant.push_back(v);
    found.rows.push_back(std::int64_t(p.kept_times.size()));
    found.times.insert(found.times.end(), p.kept_times.begin(), p.kept_times.end());
    found.values.insert(found.values.end(), p.kept.begin(), p.kept.end());
    p.ends.resize(2 * std::size_t(task_.width));
    found.ends.insert(found.ends.end(), p.ends.begin(), p.ends.end());
    p.kept_times.clear(), p.kept.clear(), p.ends.clear();
    return member.status;
  }

  void keep(const double* row, double* to) const {
    for (std::int64_t c = 0; c < task_.width; ++c) to[c] = row[task_.columns[c]];
  }

  /// Events make room for others, kept or not.
  void take_events(cw_run* run, std::int64_t v) {
    const std::int64_t size = cw_event_size();
    std::int64_t n;
    while ((n = cw_take_events(run, event_.data(), event_room)) > 0) {
      for (std::int64_t i = 0; task_.events && i < n; ++i) {
        const double* e = event_.data() + i * size;
        found.events.insert(found.events.end(), {double(v), e[0], e[1], e[2], e[3]});
      }
    }
  }

  /// Why a run stopped: a component, or what of a row is not finite, else its largest number.
  void tell(const Place& p, std::int64_t v, int status) {
    double* detail = results_.detail + v * detail_size;
    double value = 0;
    const std::int64_t component = cw_detail(p.run, &value);
    std::int64_t column = cw_detail_row(p.run);
    if (status == int(Status::not_finite) && component < 0 && column < 0) {
      std::vector<double> row(std::size_t(p.row_size), 0.0);
      cw_row(p.run, row.data());
      column = 0;
      for (std::int64_t i = 0; i < p.row_size && !std::isnan(row[std::size_t(column)]); ++i)
        if (!(std::abs(row[std::size_t(i)]) <= std::abs(row[std::size_t(column)]))) column = i;
      value = p.row_size > 0 ? row[std::size_t(column)] : 0;
    }
    detail[0] = double(component), detail[1] = cw_time(p.run), detail[2] = value, detail[3] = double(column);
  }
};

/// Run all variants on so many threads; `pause` is called now and then by the thread that waits, and stops them all by
/// returning true.
template <class Pause>
std::vector<Found> run_all(const Task& task, const Results& results, int threads, Course& course, Pause&& pause) {
  std::vector<std::unique_ptr<Worker>> workers;
  for (int i = 0; i < threads; ++i) workers.push_back(std::make_unique<Worker>(task, results, course));
  on_threads(threads, course, pause, [&](int number) { workers[std::size_t(number)]->work(); });
  std::vector<Found> found;
  for (auto& worker : workers) found.push_back(std::move(worker->found));
  return found;
}

}  // namespace clutchwork::sweep
