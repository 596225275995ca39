#pragma once
#include <clutchwork/lanes/mode.hpp>
#include <clutchwork/lanes/together.hpp>
#include <clutchwork/run/advance.hpp>

#include <new>

/// Up to eight runs advanced together, with the results of each one alone: docs/theory/lanes.md.
namespace clutchwork {

/// One run of a group.
struct Member {
  Workspace<double>* run = nullptr;
  Sink* sink = nullptr;
  Status status = Status::running;
  bool begun = false;  ///< its phase has
  alignas(64) unsigned char phase[sizeof(LanePhase)];

  LanePhase& own_phase() { return *std::launder(reinterpret_cast<LanePhase*>(phase)); }
  StepSize<double>& pace() { return own_phase(); }
};

/// Up to eight runs of models with the same structure.
class Group {
  Workspace<Lanes<2>>& lanes_;
  const LaneKernel& kernel_;
  Member* member_;
  const int n_;
  const double t_end_;

 public:
  Group(Workspace<Lanes<2>>& lanes, const LaneKernel& kernel, Member* members, int n, double t_end)
      : lanes_(lanes), kernel_(kernel), member_(members), n_(n), t_end_(t_end) {}

  /// The statuses are in the members.
  void advance() {
    for (int i = 0; i < n_lanes; ++i) put_model(lanes_, *member_[i < n_ ? i : 0].run, i);
    for (int i = 0; i < n_; ++i) member_[i].status = reach_phase(*member_[i].run);
    for (int first = earliest(); first >= 0; first = earliest()) {
      bool along[n_lanes] = {};
      const int count = company(first, along);
      count < worthwhile ? step_alone(member_[first]) : step_together(along);
    }
  }

 private:
  // a step of all lanes costs as much as those of two or three runs
  static constexpr int worthwhile = 3;

  /// The run that is behind all others that go on; -1: none does.
  int earliest() const {
    int first = -1;
    for (int i = 0; i < n_; ++i) {
      if (member_[i].status != Status::running) continue;
      if (first < 0 || member_[i].run->time < member_[first].run->time) first = i;
    }
    return first;
  }

  /// Those in the mode of the first one, and their number.
  int company(int first, bool* along) const {
    int count = 0;
    const Workspace<double>& run = *member_[first].run;
    if (!may_share(run)) return 1;
    for (int i = 0; i < n_; ++i) {
      if (member_[i].status != Status::running || !may_share(*member_[i].run)) continue;
      along[i] = same_mode(run, *member_[i].run);
      count += along[i];
    }
    return count;
  }

  /// A phase is over: what comes after it.
  void close(Member& m, Status status) {
    m.begun = false;
    m.status = status;
    if (m.status == Status::running && !m.run->stiffened) m.status = switch_modes(*m.run);
    if (m.status == Status::running) m.status = reach_phase(*m.run);
  }

  void step_alone(Member& m) {
    Workspace<double>& run = *m.run;
    if (!m.begun) return close(m, dispatch(run, t_end_, *m.sink));
    close(m, m.own_phase().resume());
  }

  void step_together(const bool* along) {
    LanePhase* phases[n_lanes] = {};
    int count = 0, first = 0;
    for (int i = 0; i < n_; ++i) {
      if (!along[i]) continue;
      Member& m = member_[i];
      if (!m.begun) (new (m.phase) LanePhase(*m.run, t_end_, *m.sink, Tag<Rodas5P>{}))->begin();
      m.begun = true;
      if (m.pace().over_) {
        close(m, m.pace().status_);
      } else {
        phases[i] = &m.own_phase();
        first = i, ++count;
      }
    }
    if (count < 2) return;
    Together(lanes_, kernel_, phases, first).run();
    for (int i = 0; i < n_; ++i) {
      if (phases[i] != nullptr && member_[i].pace().over_) close(member_[i], member_[i].pace().status_);
    }
  }
};

}  // namespace clutchwork
