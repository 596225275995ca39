#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/workspace/loads.hpp>
#include <cstdint>

/// Torques of contacts at rest and in slip where some of them follow loads that all of them make:
/// docs/theory/load-dependent.md.
namespace clutchwork {

/// One problem of n contacts. Each sticks, or slips with the torque of one of its bounds; that of a contact which
/// follows a load is a line over the load.
template <class T>
struct CoupledProblem : CoupledMemory<T> {
  using CoupledMemory<T>::bound, CoupledMemory<T>::load;
  int n = 0, loads = 0;
  bool either = false;  ///< whether torques count that answer the wrong way round

  const Bound<T>& against(int k, int direction) const { return bound[2 * load[k] + (direction > 0 ? 1 : 0)]; }
};

/// Loads and slip accelerations of the torques x.
template <class T>
void follow(CoupledProblem<T>& p) {
  for (int l = 0; l < p.loads; ++l) p.now[l] = p.given[l] + dot(p.n, p.reach + l * p.n, p.x);
  for (int i = 0; i < p.n; ++i) p.slope[i] = p.gradient[i] + dot(p.n, p.mobility + i * p.n, p.x);
}

/// Torque of a contact that slips, or how far its slip acceleration is from zero where it sticks, at the present x.
template <class T>
T missing(const CoupledProblem<T>& p, int i, bool regular) {
  if (p.state[i] == 0) return -(p.slope[i] + (regular ? p.weight[i] * p.x[i] : T(0)));
  if (p.load[i] < 0) return (p.state[i] > 0 ? p.lower[i] : p.upper[i]) - p.x[i];
  return T(-p.state[i]) * p.against(i, p.state[i]).on(p.line[i], p.now[p.load[i]]) - p.x[i];
}

/// Torques of the present states: one linear system, refined. False: it is singular.
/// docs/theory/load-dependent.md (9)
template <class T>
bool solve_states(CoupledProblem<T>& p) {
  const int n = p.n;
  for (int i = 0; i < n; ++i) {
    T* row = p.matrix + i * n;
    if (p.state[i] == 0) {
      for (int j = 0; j < n; ++j) row[j] = p.mobility[i * n + j];
      row[i] += p.weight[i];
      continue;
    }
    for (int j = 0; j < n; ++j) row[j] = T(0);
    if (p.load[i] >= 0) {
      const T slope = p.against(i, p.state[i]).slope[p.line[i]] * T(p.state[i]);
      for (int j = 0; j < n; ++j) row[j] = slope * p.reach[p.load[i] * n + j];
    }
    row[i] += T(1);
  }
  if (!factor_lu(n, p.matrix, p.pivot)) return false;
  // from any start; the last steps take out the weight, as long as that brings the torques closer
  double before = infinity;
  for (int step = 0; step < 5; ++step) {
    follow(p);
    double size = 0;
    for (int i = 0; i < n; ++i) p.trial[i] = missing(p, i, step < 2), size = larger(size, abs(value(p.trial[i])));
    if (step >= 2 && !(size < before)) break;
    if (step >= 2) before = size;
    solve_lu(n, p.matrix, p.pivot, p.trial);
    for (int i = 0; i < n; ++i) p.x[i] += p.trial[i];
  }
  follow(p);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += value(p.x[i]) * 0 + value(p.slope[i]) * 0;
  return sum == 0;
}

/// Whether the torques that were solved for answer what drives them the right way round: the determinant of their
/// system is positive. docs/theory/load-dependent.md, rule 4
template <class T>
bool answers(const CoupledProblem<T>& p) {
  bool positive = true, slips = false;
  for (int i = 0; i < p.n; ++i) {
    slips = slips || (p.state[i] != 0 && p.load[i] >= 0);
    positive = positive == ((value(p.matrix[i * p.n + i]) > 0) == (p.pivot[i] == i));
  }
  return positive || !slips;
}

/// Round-off of a torque, of a slip acceleration and of a load of contact i.
template <class T>
struct Rounding {
  double torque = 0, slope = 0;
};
template <class T>
Rounding<T> rounding(const CoupledProblem<T>& p, int i) {
  Rounding<T> made;
  made.slope = abs(value(p.gradient[i]));
  for (int j = 0; j < p.n; ++j) {
    made.slope = larger(made.slope, abs(value(p.mobility[i * p.n + j] * p.x[j])));
    made.torque = larger(made.torque, abs(value(p.x[j])));
    // what is left where another one is let go, or held, that nothing else moves
    const double own = value(p.mobility[j * p.n + j]);
    if (own > 0) made.slope = larger(made.slope, 1e-3 * abs(value(p.mobility[i * p.n + j] * p.gradient[j])) / own);
  }
  for (int l = 0; l < p.loads; ++l) made.torque = larger(made.torque, abs(value(p.given[l])));
  return {1e-11 * made.torque, 1e-11 * made.slope};
}

/// State and line that contact i should have at the present torques. docs/theory/load-dependent.md (10)
template <class T>
void wanted(const CoupledProblem<T>& p, int i, int& state, int& line) {
  const Rounding<T> noise = rounding(p, i);
  T low = p.lower[i], high = p.upper[i];
  state = p.state[i], line = p.line[i];
  if (p.load[i] >= 0) {
    const T load = p.now[p.load[i]];
    const Bound<T>&ahead = p.against(i, 1), &behind = p.against(i, -1);
    low = -ahead.at(load), high = behind.at(load);
    const int going = state != 0 ? state : value(p.x[i]) > 0 ? -1 : 1;
    const Bound<T>& own = p.against(i, going);
    const double gain = value(own.on(1 - line, load)) - value(own.on(line, load));
    if (state == 0 || gain > noise.torque) line = own.line_at(load);
  }
  const double slope = value(p.slope[i]);
  if (p.sliding[i] != 0) {
    // one that is let go moves the way it is let go
    if (p.starts[i] != 0 && slope * p.state[i] < -noise.slope) line = 1 - p.line[i];
    return;
  }
  if (state == 0) {
    if (value(p.x[i]) > value(high) + noise.torque) state = -1;
    if (value(p.x[i]) < value(low) - noise.torque) state = 1;
    // no torque keeps it at rest beside the others that rest
    const double apart = 1e-6 * abs(value(p.gradient[i])) + noise.slope;
    if (p.load[i] >= 0 && abs(slope) > apart) state = slope > 0 ? 1 : -1;
  } else if (slope * state < -noise.slope) {
    state = 0;
  }
}

/// Which of those that want another state get it in a round: all, the first alone, or those that a draw allows.
enum class Changes { all, first, drawn };

/// Draws that are the same in every run.
struct Draws {
  std::uint64_t bits;

  bool next() {
    bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
    return (bits >> 32 & 1) != 0;
  }
};

/// Those that want another state or line get it, as the rule says. How many wanted one.
template <class T>
int change_states(CoupledProblem<T>& p, Changes rule, Draws& draws) {
  int changes = 0;
  for (int i = 0; i < p.n; ++i) wanted(p, i, p.next[2 * i], p.next[2 * i + 1]);
  for (int i = 0; i < p.n; ++i) {
    if (p.next[2 * i] == p.state[i] && p.next[2 * i + 1] == p.line[i]) continue;
    const bool counts = p.next[2 * i] != p.state[i] || p.state[i] != 0;
    const bool may = rule == Changes::all || (rule == Changes::first ? changes == 0 : draws.next());
    if (!counts || may) p.state[i] = p.next[2 * i], p.line[i] = p.next[2 * i + 1];
    changes += counts;
  }
  return changes;
}

/// The next of all combinations of states and lines; false: that was the last.
template <class T>
bool count_on(CoupledProblem<T>& p) {
  for (int i = 0; i < p.n; ++i) {
    const int lines = p.load[i] >= 0 ? 2 : 1;
    if (p.state[i] != 0 && p.line[i] + 1 < lines) return ++p.line[i], true;
    p.line[i] = 0;
    if (p.sliding[i] == 0) {
      if (p.state[i] == 0) return p.state[i] = 1, true;
      if (p.state[i] == 1) return p.state[i] = -1, true;
      p.state[i] = 0;
    }
  }
  return false;
}

/// How many combinations there are, at most `most`.
template <class T>
long combinations(const CoupledProblem<T>& p, long most) {
  long all = 1;
  for (int i = 0; i < p.n && all < most; ++i) {
    const int lines = p.load[i] >= 0 ? 2 : 1;
    all *= p.sliding[i] != 0 ? lines : 1 + 2 * lines;
  }
  return all;
}

inline constexpr long most_combinations = 4096;

template <class T>
void start_states(CoupledProblem<T>& p) {
  for (int i = 0; i < p.n; ++i) {
    p.state[i] = p.sliding[i], p.x[i] = T(0);
    if (p.sliding[i] == 0) p.line[i] = 0;
  }
}

/// A number of the present states and lines, another one for others.
template <class T>
std::uint64_t mark_of_states(const CoupledProblem<T>& p) {
  std::uint64_t mark = 0;
  for (int i = 0; i < p.n; ++i) mark = mark * 0x9e3779b97f4a7c15u + std::uint64_t(2 * (p.state[i] + 1) + p.line[i] + 1);
  return mark;
}

/// Policy iteration from all at rest: each round solves for the torques and gives contacts the state that they ask for.
/// False: it does not settle, as where states come back.
template <class T>
bool iterate_states(CoupledProblem<T>& p, Changes rule, std::uint64_t start = 1) {
  start_states(p);
  std::uint64_t seen = 0;
  Draws draws{start};
  for (int round = 0, kept = 1; round < 40 * p.n + 60; ++round) {
    if (!solve_states(p)) return false;
    if (change_states(p, rule, draws) == 0) return p.either || answers(p);
    if (rule == Changes::drawn) continue;
    const std::uint64_t mark = mark_of_states(p);
    if (mark == seen) return false;
    // a cycle comes back to what is kept for twice as long each time
    if (round == kept) seen = mark, kept *= 2;
  }
  return false;
}

/// All combinations, those at rest first; false: none fits.
template <class T>
bool enumerate_states(CoupledProblem<T>& p) {
  if (combinations(p, most_combinations) >= most_combinations) return false;
  for (int i = 0; i < p.n; ++i) p.line[i] = 0;
  start_states(p);
  do {
    // one that slips against a bound it does not have has left no numbers
    for (int i = 0; i < p.n; ++i) p.x[i] = T(0);
    if (!solve_states(p)) continue;
    bool fits = p.either || answers(p);
    for (int i = 0; i < p.n && fits; ++i) {
      int state, line;
      wanted(p, i, state, line);
      fits = state == p.state[i] && (state == 0 || line == p.line[i]);
    }
    if (fits) return true;
  } while (count_on(p));
  return false;
}

/// Among many contacts no combination is met by chance, but draws leave the rounds in which states come back.
template <class T>
bool draw_states(CoupledProblem<T>& p) {
  constexpr int tries = 20;
  if (combinations(p, most_combinations) < most_combinations) return false;
  for (std::uint64_t k = 1; k <= tries; ++k) {
    if (iterate_states(p, Changes::drawn, k * 0x9e3779b97f4a7c15u)) return true;
  }
  return false;
}

template <class T>
bool search_states(CoupledProblem<T>& p) {
  return iterate_states(p, Changes::all) || iterate_states(p, Changes::first) || enumerate_states(p) || draw_states(p);
}

/// Torques, states and lines that fit together; where those that are let go cannot all move that way, as they can;
/// where none answers the right way round at rest, any. False: there are none, or they were not found.
template <class T>
bool solve(CoupledProblem<T>& p) {
  if (search_states(p)) return true;
  bool any = false, moves = false;
  for (int i = 0; i < p.n; ++i) {
    moves = moves || (p.sliding[i] != 0 && p.starts[i] == 0 && p.load[i] >= 0);
    any = any || p.starts[i] != 0, p.starts[i] = 0;
  }
  if (any && search_states(p)) return true;
  p.either = !moves;
  return p.either && search_states(p);
}

}  // namespace clutchwork
