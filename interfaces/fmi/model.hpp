#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// What the resource of an FMU says of its model: docs/guide/fmu.md.
namespace clutchwork::fmi {

enum class Kind { time, input, slope, tunable, fixed, signal, mode, rate, margin };
inline constexpr int kinds = 9;

/// A number in the bytes of the System, or in the pool of parameters, that follows a value along a straight line.
struct Place {
  std::int64_t number;
  double slope;  ///< not a number: it is the value itself
};

/// A number of the form of an output that follows a parameter, or its reciprocal.
struct Follows {
  std::int64_t form, term, side, share;  ///< share -1: the offset
  bool is_reciprocal;
  double slope;

  double change(double start, double value) const {
    return slope * (is_reciprocal ? 1 / value - 1 / start : value - start);
  }
};

struct Variable {
  Kind kind;
  std::string name;
  std::string bounds;  ///< in words
  double start, least, most, nominal;
  std::int64_t of;                   ///< a slope: its input; a signal or mode: its form; a rate: its continuous state;
                                     ///< a margin: its number
  std::int64_t order;                ///< of a slope
  std::vector<std::int64_t> inputs;  ///< numbers in the core
  std::vector<Place> words;          ///< before a run
  std::vector<Place> params;         ///< during one
  std::vector<Follows> forms;        ///< what outputs are computed from

  bool is_parameter() const { return kind == Kind::tunable || kind == Kind::fixed; }
  bool is_given() const { return kind == Kind::input || kind == Kind::slope || is_parameter(); }
};

/// offset + sum of factor times number of a row; in this order.
struct Combination {
  bool has_offset;
  double offset;
  std::vector<Place> parts;

  double operator()(const double* row) const;
};

/// A combination, or the product of two, the second of which is zero while a contact is locked.
struct Term {
  Combination one, other;
  bool is_product;
  std::int64_t gate;  ///< place of a mode in the row; -1: none

  double operator()(const double* row) const;
};

/// A signal as a sum of terms.
struct Form {
  std::vector<Term> terms;

  double operator()(const double* row) const;
};

struct Option {
  std::string name;
  double value;
};

struct Sentence {
  std::string message, remedy;
};

/// An element or contact, as messages name it.
struct Part {
  std::string name, covered;
  Sentence jam;
};

/// A continuous state: a number of the state of the core.
struct ContinuousState {
  std::int64_t number;
  double nominal;
  std::int64_t variable;  ///< value reference
};

/// What is said of a resource with other contents than were exported.
inline constexpr const char* damaged_resource = "the resource of this FMU is damaged: export the model again";

struct Model {
  std::string token;
  std::vector<unsigned char> system;
  double t_start;
  std::vector<Option> options;
  std::vector<Variable> variables;
  std::vector<Form> forms;
  std::vector<Part> parts;  ///< elements, then contacts
  std::int64_t elements;
  std::vector<std::string> row, inputs, crowded;  ///< names
  std::vector<Sentence> statuses;
  std::vector<std::string> causes, modes;  ///< words by number; modes from the least one on
  bool exchanges;                          ///< it is for model exchange too
  std::vector<ContinuousState> states;     ///< continuous ones

  /// Whether it has steps of one length.
  bool is_fixed() const;

  /// Read from a file; what is wrong with it, empty where nothing is.
  std::string load(const std::string& path);
  /// Whether states and indicators are among those of the core.
  bool has_places(std::int64_t continuous, std::int64_t indicators) const;

 private:
  std::string read(const std::vector<unsigned char>& bytes);
};

}  // namespace clutchwork::fmi
