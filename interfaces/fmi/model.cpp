#include "model.hpp"

#include <clutchwork/c_api.h>
#include <clutchwork/workspace/settings.hpp>

#include <cmath>
#include "files.hpp"
#include "reader.hpp"

namespace clutchwork::fmi {

namespace {

constexpr char magic[8] = {'C', 'W', 'F', 'M', 'U', '0', '0', '4'};
constexpr std::int64_t many = std::int64_t(1) << 40;

/// A checksum of words.
std::int64_t checksum(const unsigned char* bytes, std::int64_t n) {
  std::uint64_t sum = std::uint64_t(n), word = 0;
  for (std::int64_t at = 0; at + 8 <= n; at += 8) {
    std::memcpy(&word, bytes + at, 8);
    sum = (sum ^ word) * 0x9e3779b97f4a7c15u;
    sum ^= sum >> 32;
  }
  return std::int64_t(sum);
}

Combination combination(Reader& from, std::int64_t row_size) {
  Combination made{};
  made.has_offset = from.integer(0, 1) != 0;
  made.offset = from.number();
  made.parts.resize(std::size_t(from.count(16)));
  for (Place& part : made.parts) part.number = from.integer(0, row_size - 1), part.slope = from.number();
  return made;
}

Form form(Reader& from, std::int64_t row_size) {
  Form made;
  made.terms.resize(std::size_t(from.count(64)));
  for (Term& term : made.terms) {
    term.gate = from.integer(-1, row_size - 1);
    term.is_product = from.integer(0, 1) != 0;
    term.one = combination(from, row_size);
    term.other = combination(from, row_size);
  }
  return made;
}

std::vector<Place> places(Reader& from, std::int64_t size) {
  std::vector<Place> made(std::size_t(from.count(16)));
  for (Place& place : made) place.number = from.integer(0, size - 1), place.slope = from.number();
  return made;
}

Variable variable(Reader& from, std::int64_t words) {
  Variable made{};
  made.kind = Kind(from.integer(0, kinds - 1));
  made.name = from.text(), made.bounds = from.text();
  made.start = from.number(), made.least = from.number(), made.most = from.number();
  made.nominal = from.number();
  made.of = from.integer(-1, many), made.order = from.integer(0, 3);
  made.inputs.resize(std::size_t(from.count(8)));
  for (std::int64_t& input : made.inputs) input = from.integer(0, many);
  made.words = places(from, words);
  made.params = places(from, words);
  made.forms.resize(std::size_t(from.count(48)));
  for (Follows& one : made.forms) {
    one.form = from.integer(0, many), one.term = from.integer(0, many), one.side = from.integer(0, 1);
    one.share = from.integer(-1, many), one.is_reciprocal = from.integer(0, 1) != 0, one.slope = from.number();
  }
  return made;
}

std::vector<std::string> texts(Reader& from) {
  std::vector<std::string> made(std::size_t(from.count(8)));
  for (std::string& text : made) text = from.text();
  return made;
}

/// Whether a number of an output is there.
bool is_there(const Follows& one, const std::vector<Form>& forms) {
  if (one.form >= std::int64_t(forms.size())) return false;
  const auto& terms = forms[std::size_t(one.form)].terms;
  if (one.term >= std::int64_t(terms.size())) return false;
  const Term& term = terms[std::size_t(one.term)];
  return one.share < std::int64_t((one.side == 0 ? term.one : term.other).parts.size());
}

/// Whether what variables refer to is there.
bool is_joined(const Model& model) {
  const auto variables = std::int64_t(model.variables.size()), forms = std::int64_t(model.forms.size());
  const auto states = std::int64_t(model.states.size());
  for (const Variable& one : model.variables) {
    for (const Follows& number : one.forms)
      if (!is_there(number, model.forms)) return false;
    if (one.kind == Kind::slope && (one.of < 0 || one.of >= variables || one.order < 1)) return false;
    if (one.kind == Kind::slope && model.variables[std::size_t(one.of)].kind != Kind::input) return false;
    if ((one.kind == Kind::signal || one.kind == Kind::mode) && (one.of < 0 || one.of >= forms)) return false;
    if (one.kind == Kind::rate && (one.of < 0 || one.of >= states)) return false;
  }
  return true;
}

}  // namespace

bool Model::has_places(std::int64_t continuous, std::int64_t indicators) const {
  for (const ContinuousState& one : states)
    if (one.number >= continuous || one.variable >= std::int64_t(variables.size())) return false;
  for (const Variable& one : variables)
    if (one.kind == Kind::margin && (one.of < 0 || one.of >= indicators)) return false;
  return true;
}

double Combination::operator()(const double* row) const {
  double sum = has_offset ? offset : 0.0;
  bool first = !has_offset;
  for (const Place& part : parts) {
    const double value = part.slope * row[part.number];
    sum = first ? value : sum + value;
    first = false;
  }
  return sum;
}

double Term::operator()(const double* row) const {
  const double value = one(row);
  if (!is_product) return gate >= 0 && row[gate] == 0.0 ? 0.0 : value;
  return value * (gate >= 0 && row[gate] == 0.0 ? 0.0 : other(row));
}

double Form::operator()(const double* row) const {
  double sum = terms.empty() ? 0.0 : terms[0](row);
  for (std::size_t k = 1; k < terms.size(); ++k) sum += terms[k](row);
  return sum;
}

bool Model::is_fixed() const {
  for (const Option& option : options) {
    if (option.name == "method" && option.value == double(Method::fixed)) return true;
  }
  return false;
}

std::string Model::load(const std::string& path) {
  std::vector<unsigned char> bytes;
  if (!read_file(path, bytes)) return "cannot read " + path + ": unpack the FMU again, with its resources";
  return read(bytes);
}

std::string Model::read(const std::vector<unsigned char>& bytes) {
  if (bytes.size() < 16 || std::memcmp(bytes.data(), magic, sizeof magic) != 0) return damaged_resource;
  Reader from(bytes.data() + sizeof magic, std::int64_t(bytes.size() - sizeof magic));
  if (from.integer(INT64_MIN, INT64_MAX) != cw_schema_hash())
    return "the library and the resource of this FMU are of different versions of clutchwork: export the model again";
  token = from.text();
  const std::int64_t sum = from.integer(INT64_MIN, INT64_MAX);
  if (!from.whole() || sum != checksum(from.rest(), from.left())) return damaged_resource;
  std::int64_t n = 0;
  const unsigned char* data = from.bytes(&n);
  system.assign(data, data + n);
  const std::int64_t row_size = from.integer(0, many);
  t_start = from.number();
  options.resize(std::size_t(from.count(16)));
  for (Option& option : options) option.name = from.text(), option.value = from.number();
  variables.resize(std::size_t(from.count(96)));
  for (Variable& one : variables) one = variable(from, std::int64_t(system.size()) / 8);
  forms.resize(std::size_t(from.count(8)));
  for (Form& one : forms) one = form(from, row_size);
  elements = from.integer(0, many);
  parts.resize(std::size_t(from.count(32)));
  for (Part& part : parts) {
    part.name = from.text(), part.covered = from.text();
    part.jam.message = from.text(), part.jam.remedy = from.text();
  }
  row = texts(from), inputs = texts(from), crowded = texts(from);
  statuses.resize(std::size_t(from.count(16)));
  for (Sentence& one : statuses) one.message = from.text(), one.remedy = from.text();
  causes = texts(from), modes = texts(from);
  exchanges = from.integer(0, 1) != 0;
  states.resize(std::size_t(from.count(24)));
  for (ContinuousState& one : states)
    one.number = from.integer(0, many), one.nominal = from.number(), one.variable = from.integer(0, many);
  const bool fits = cw_size(system.data(), std::int64_t(system.size())) > 0 && std::int64_t(row.size()) == row_size;
  return from.is_at_end() && fits && is_joined(*this) ? "" : damaged_resource;
}

}  // namespace clutchwork::fmi
