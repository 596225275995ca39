// The loop that a sweep is measured against: one System, another number in each run, as many threads as are asked for.
// sweep_loop SYSTEM OFFSET FIRST LAST VARIANTS THREADS T_END WORK: wall and processor seconds, sum of the last rows.
#include <clutchwork/c_api.h>
#include <time.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>
#include <vector>

struct alignas(64) Block {
  unsigned char byte[64];
};

int main(int argc, char** argv) {
  if (argc != 9) return 1;
  std::ifstream file(argv[1], std::ios::binary);
  const std::vector<char> system((std::istreambuf_iterator<char>(file)), {});
  const long offset = std::atol(argv[2]), variants = std::atol(argv[5]), threads = std::atol(argv[6]);
  const double first = std::atof(argv[3]), last = std::atof(argv[4]), t_end = std::atof(argv[7]),
               work = std::atof(argv[8]);
  const auto bytes = std::int64_t(system.size()), size = cw_size(system.data(), bytes);
  if (size < 0) return 1;
  std::atomic<long> next{0};
  std::vector<double> sums(std::size_t(variants), 0.0);
  auto run_all = [&] {
    const auto memory = std::make_unique<Block[]>(std::size_t(size + 63) / 64);
    std::vector<double> row;
    for (long v; (v = next.fetch_add(1)) < variants;) {
      cw_run* run = cw_load(system.data(), bytes, memory.get(), size);
      cw_set_option(run, "angles", work), cw_set_option(run, "work", work);
      if (!cw_set_param(run, offset, first + (last - first) * double(v) / double(variants - 1))) std::exit(3);
      row.resize(std::size_t(cw_row_size(run)));
      double end = t_end;
      std::int64_t filled = 0;
      if (cw_advance(run, t_end, &end, row.data(), 1, 0, &filled) != 0) std::exit(2);
      sums[std::size_t(v)] = row[0];
    }
  };
  timespec before, after;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
  const auto started = std::chrono::steady_clock::now();
  std::vector<std::thread> running;
  for (long i = 0; i < threads; ++i) running.emplace_back(run_all);
  for (auto& thread : running) thread.join();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
  double sum = 0;
  for (double one : sums) sum += one;
  std::printf("%.9g %.9g %.17g\n", wall.count(),
              double(after.tv_sec - before.tv_sec) + 1e-9 * double(after.tv_nsec - before.tv_nsec), sum);
}
