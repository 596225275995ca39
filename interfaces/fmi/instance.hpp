#pragma once
#include <clutchwork/c_api.h>

#include <memory>
#include <string>
#include <vector>
#include "model.hpp"

/// One instance of an FMU, as both versions of the standard see it. docs/guide/fmu.md
namespace clutchwork::fmi {

/// As the numbers of fmi2Status and fmi3Status.
enum class Answer { ok, warning, discard, error, fatal };

enum class Category { error, warning, events };
inline constexpr int categories = 3;
inline constexpr const char* category_names[categories] = {"error", "warning", "events"};

/// What an importer does with a message.
struct Listener {
  void* who = nullptr;
  void (*say)(void* who, Answer answer, const char* category, const char* text) = nullptr;
};

/// Derivatives that an input may have.
inline constexpr int orders = 3;

/// A number as messages quote it.
std::string number(double x);

/// Where an instance is in its life.
enum class Stage { instantiated, initialization, step, event, terminated, failed };

/// Who takes the steps: the instance, or the importer by the rates that it gets.
enum class Purpose { co_simulation, model_exchange };

/// Everything of an instance that a state holds.
struct State {
  Stage stage = Stage::instantiated;
  bool is_loaded = false;
  double t_start = 0;
  double rtol = 0;                 ///< 0: that of the model
  std::vector<double> value;       ///< of all variables; those of signals are not used
  std::vector<double> loaded;      ///< values with which the run was loaded
  std::vector<double> on_line;     ///< 1 for an input that the core has as a line, else 0
  std::vector<double> slopes;      ///< three of each variable: derivatives of an input over the coming step
  std::vector<double> past;        ///< and those at the end of the last one
  double time = 0;                 ///< [s] model exchange: of the importer
  bool is_anew = false;            ///< inputs or parameters were set in event mode
  std::vector<double> x;           ///< the state of the core, of which continuous states are some numbers
  std::vector<unsigned char> run;  ///< a copy of the run, where it is loaded
};

/// Where a motion is looked at: time [s], the state of the core, values and derivatives of variables.
struct Point {
  double time = 0;
  std::vector<double> x, value, slopes;
};

/// A way through points, per unit of which something changes.
using Direction = Point;

/// Variables by value reference.
struct References {
  const std::uint32_t* at;
  std::size_t n;
};

/// What a step did.
struct Stepped {
  Answer answer = Answer::ok;
  bool is_early = false;
};

class Instance {
 public:
  /// The instance of a resource, or null with what is wrong in the log.
  static Instance* make(const std::string& path, const char* token, Listener listener, Purpose purpose);

  // what is in the log
  Answer say(Answer answer, Category category, const std::string& text) const;
  Answer refuse(const std::string& text) const { return say(Answer::error, Category::error, text); }
  void log(bool on, Category category) { is_logged_[int(category)] = on; }

  // life
  Stage stage() const { return now_.stage; }
  const Model& model() const { return model_; }
  bool exchanges() const { return purpose_ == Purpose::model_exchange; }
  double time() const { return !now_.is_loaded ? now_.t_start : is_placed() ? now_.time : cw_time(run()); }
  Answer experiment(double t_start, bool has_tolerance, double tolerance);
  Answer initialize();
  Answer enter(Stage stage);
  void reset();

  // variables by value reference
  const Variable* variable(std::uint32_t reference) const;
  Answer check(std::uint32_t reference, double value) const;  ///< whether it may be set now
  Answer set(std::uint32_t reference, double value);
  Answer get(std::uint32_t reference, double* value);
  Answer set_slope(std::uint32_t input, int order, double value);

  // steps; at an early return the run is right after an event
  Stepped step(double from, double size, bool may_return_early);
  void forget_slopes();
  bool has_next_knot() const { return next_knot() > time() && next_knot() < 1e300; }
  double next_knot() const { return now_.is_loaded ? cw_next_knot(run()) : cw_next_knot(nullptr); }

  // model exchange
  std::size_t state_count() const { return model_.states.size(); }
  std::size_t margin_count() const;
  Answer set_time(double t);
  Answer set_states(const double* x, std::size_t n);
  Answer get_states(double* x, std::size_t n);
  Answer rates(double* dx, std::size_t n);
  Answer margins(double* z, std::size_t n);
  Answer nominals(double* sizes, std::size_t n) const;
  Answer decide(bool* changed);

  // derivatives, the modes of all contacts held: by seeds of knowns, or with seeds of unknowns
  Answer derivatives(const References& of, const References& by, const double* seed, double* found);
  Answer adjoint(const References& of, const References& by, const double* seed, double* found);
  Answer output_rates(const References& of, double* rates);

  // states
  State* state();
  Answer go_to(const State& state);
  std::vector<unsigned char> serialized(const State& state);
  State* deserialized(const unsigned char* bytes, std::int64_t n);

 private:
  Instance(Listener listener, Purpose purpose) : listener_(listener), purpose_(purpose) {}

  cw_run* run() const { return run_; }
  bool is_begun() const { return now_.stage != Stage::instantiated && now_.stage != Stage::initialization; }
  /// Whether time and state are those of the importer.
  bool is_placed() const { return exchanges() && is_begun(); }
  std::string told(int status) const;
  bool is_possible(const State& state) const;
  bool load();
  bool put(const std::vector<double>& values);
  void follow(const std::vector<double>& values);
  bool is_line(std::size_t input) const;
  bool look();
  bool place();
  bool stand(double time, const std::vector<double>& x, const std::vector<double>& value,
             const std::vector<double>& slopes);
  double computed(const Variable& one) const;
  bool begin();
  Direction no_direction() const;
  Answer turn(std::uint32_t known, double seed, Direction& into) const;
  Answer check_results(const References& of);
  bool find(Point& here);
  bool follow_motion(Point& here, Direction& along);
  double length(const Direction& along, const Point& here) const;
  int way_from_zero(const Direction& along, const Point& here, double by) const;
  Answer change(Direction along, bool is_motion, const References& of, double* rates);
  bool has_room(const double* numbers, std::size_t n, std::size_t wanted, const char* what) const;
  void give_inputs();
  void follow_slopes(double seconds);
  void give_budget();
  void take_events();
  Answer stop(int status);

  Listener listener_;
  Purpose purpose_;
  bool is_logged_[categories] = {true, true, false};
  Model model_;
  State now_;
  std::vector<Form> forms_;  ///< with the present parameters; empty: those of the model
  std::vector<unsigned char> system_, memory_, before_;
  std::vector<double> row_, events_, rates_, margins_;
  cw_run* run_ = nullptr;
  bool is_seen_ = false;   ///< the row is that of the present time
  bool is_rated_ = false;  ///< and so are the rates
};

}  // namespace clutchwork::fmi
