// The core and floor.cpp in turns in one process, so that both see the same clock of the processor.
// pair SYSTEM T_END TURNS: for Rodas5P and DOPRI5 a line with the CPU time of the core and of floor.cpp [us], each the
// 10th percentile and the median, the median of the ratios of neighbours, and instructions of one run of each, 0 where
// the system counts none.
#define main floor_main
#include "floor.cpp"
#undef main

#include <clutchwork/c_api.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>

#ifdef __linux__
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

/// Instructions of this thread outside of the kernel.
static double instructions_of(auto&& work) {
  perf_event_attr what{};
  what.type = PERF_TYPE_HARDWARE, what.size = sizeof what, what.config = PERF_COUNT_HW_INSTRUCTIONS;
  what.disabled = what.exclude_kernel = what.exclude_hv = 1;
  const int counter = int(syscall(SYS_perf_event_open, &what, 0, -1, -1, 0));
  if (counter < 0) return 0;
  std::uint64_t count = 0;
  ioctl(counter, PERF_EVENT_IOC_ENABLE, 0);
  work();
  ioctl(counter, PERF_EVENT_IOC_DISABLE, 0);
  const bool known = read(counter, &count, sizeof count) == sizeof count;
  close(counter);
  return known ? double(count) : 0;
}
#else
static double instructions_of(auto&&) { return 0; }
#endif

/// The shift in the core, put back to its start before each turn.
struct Core {
  std::vector<char> system, state;
  std::vector<double> memory, events;
  cw_run* run;
  double t_end;

  Core(const char* path, double end, double method) : t_end(end) {
    std::ifstream file(path, std::ios::binary);
    system.assign(std::istreambuf_iterator<char>(file), {});
    const auto bytes = std::int64_t(system.size()), size = cw_size(system.data(), bytes);
    if (size < 0) std::exit(1);
    memory.resize(std::size_t(size) / 8 + 16);
    void* at = memory.data();
    std::size_t room = 8 * memory.size();
    run = cw_load(system.data(), bytes, std::align(64, std::size_t(size), at, room), size);
    events.resize(std::size_t(256 * cw_event_size()));
    cw_set_option(run, "method", method), cw_set_option(run, "angles", 0), cw_set_option(run, "work", 0);
    state.resize(std::size_t(cw_state_size(run)));
    cw_save(run, state.data(), std::int64_t(state.size()));
  }
  void reset() { cw_restore(run, state.data(), std::int64_t(state.size())); }
  void go() {
    std::int64_t filled;
    while (cw_advance(run, t_end, nullptr, nullptr, 0, 0, &filled) != 0) {
      if (cw_take_events(run, events.data(), 256) == 0) std::exit(2);
    }
  }
};

template <class Stepper>
static void compare(const char* name, Core core, int turns) {
  Model model;
  V y;
  auto floor = [&] {
    Sim sim(model);
    simulate<Stepper>(sim, 1e-6, 1e-8, y, nullptr, 1e-3);
  };
  auto timed = [](auto&& work) {
    const double start = cpu();
    work();
    return cpu() - start;
  };
  std::vector<double> ours, theirs, ratios;
  for (int turn = 0; turn < turns; ++turn) {
    core.reset();
    ours.push_back(timed([&] { core.go(); })), theirs.push_back(timed(floor));
    ratios.push_back(ours.back() / theirs.back());
  }
  core.reset();
  const double own = instructions_of([&] { core.go(); }), other = instructions_of(floor);
  for (auto* each : {&ours, &theirs, &ratios}) std::sort(each->begin(), each->end());
  std::printf("%s %.6g %.6g %.6g %.6g %.6g %.0f %.0f\n", name, ours[turns / 10], ours[turns / 2], theirs[turns / 10],
              theirs[turns / 2], ratios[turns / 2], own, other);
}

int main(int argc, char** argv) {
  if (argc != 4) return 1;
  const double t_end = std::atof(argv[2]);
  const int turns = std::atoi(argv[3]);
  compare<Rodas5P>("rodas5p", Core(argv[1], t_end, 1), turns);
  compare<DP5>("dopri5", Core(argv[1], t_end, 2), turns);
}
