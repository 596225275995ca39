"""layout.gen.hpp: the System in bytes, rows, events, codes and settings of the core."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from clutchwork.declare.layout import (
    CAUSES,
    COUNTS,
    EVENT,
    FEW_SPEEDS,
    FIELDS,
    METHODS,
    MODES,
    MOST_FIXED_SPEEDS,
    REFUSALS,
    ROW,
    STATISTICS,
    STATUS,
    layout_text,
)
from clutchwork.declare.schema import schema_hash
from registry.components import cpp_name
from registry.options import options

FILE = "layout.gen.hpp"
TYPES = {"f8": "double", "i4": "std::int32_t"}
NUMBERS = {"f8": "G", "i4": "std::int32_t"}
# numbers that are instants, or spans between them
INSTANTS = {"input_period", "segment_time"}


def lines() -> Iterator[str]:
    """The header without its head."""
    yield from ("#include <cstdint>", "#include <cstring>", "namespace clutchwork {")
    yield f"inline constexpr std::int64_t schema_hash = {schema_hash(layout_text())}ll;"
    yield from (*codes(), *options(), *statistics(), *system(), *binding(), *rows())
    yield "}"


def numbered(words: Iterable[tuple[str, int]]) -> str:
    """Enumerators with their numbers."""
    return ", ".join(f"{cpp_name(word)} = {number}" for word, number in words)


def codes() -> Iterator[str]:
    """Enumerations that Python knows by name."""
    statuses = [(name, number) for number, (name, *_) in enumerate(STATUS)]
    causes = [(word, number) for number, (word, _) in CAUSES.items()]
    yield "/// Why a run returned; running: it goes on."
    yield f"enum class Status : int {{ {numbered(statuses)}, running }};"
    yield "/// How a contact is."
    yield f"enum Mode : int {{ {numbered((word, number) for number, word in MODES.items())} }};"
    yield "/// What led to an event; initial: nothing did, the run starts."
    yield f"enum class Cause : int {{ initial = 0, {numbered(causes)} }};"
    yield f"inline constexpr int last_cause = {max(CAUSES)};"
    yield f"enum class Method : int {{ {numbered(METHODS.items())} }};"
    refusals = [(name, number) for number, (name, _) in REFUSALS.items()]
    yield "/// Why fixed steps do not take a component."
    yield f"enum class Refusal : int {{ taken = 0, {numbered(refusals)} }};"
    yield f"inline constexpr int last_method = {max(METHODS.values())};"


def statistics() -> Iterator[str]:
    """The counters of a run."""
    yield "/// Counters of a run."
    yield "struct Statistics {"
    for name, doc in STATISTICS:
        yield f"  std::int64_t {name} = 0;  ///< {doc}"
    yield "};"
    calls = ", ".join(f"f(s.{name})" for name, _ in STATISTICS)
    yield f"template <class S, class F> void each_statistic(S& s, F&& f) {{ {calls}; }}"
    names = ", ".join(f'"{name}"' for name, _ in STATISTICS)
    yield f"inline constexpr int n_statistics = {len(STATISTICS)};"
    yield f"inline constexpr const char* statistic_names[n_statistics] = {{{names}}};"


def member(count: str) -> str:
    """The size of a System by its name: one that is called as an array gets a prefix."""
    return f"n_{count}" if count in {name for name, *_ in FIELDS} else count


def system() -> Iterator[str]:
    """The System struct."""
    yield "/// Up to so many speeds nothing is left out of a matrix."
    yield f"inline constexpr int few_speeds = {FEW_SPEEDS};"
    yield "/// Up to so many, steps of one length are taken."
    yield f"inline constexpr int most_fixed_speeds = {MOST_FIXED_SPEEDS};"
    yield "/// Frozen model: sizes and arrays inside bytes that the caller keeps."
    yield "/// Its numbers are doubles, or carry tangents, or are single; instants are never single."
    yield "struct SystemCounts {"
    for name, doc in COUNTS:
        yield f"  std::int64_t {member(name)};  ///< {doc}"
    yield "};"
    yield "template <class G> struct InstantOf { using type = G; };"
    yield "template <class G> using Instant = typename InstantOf<G>::type;"
    yield "template <class G> struct SystemOf : SystemCounts {"
    for name, kind, shape, doc in FIELDS:
        number = "double" if name == "points" else "Instant<G>" if name in INSTANTS else NUMBERS[kind]
        yield f"  const {number}* {name};  ///< {shape} {doc}".replace("'", "")
    yield "};"
    yield "using System = SystemOf<double>;"
    yield "/// Calls f(field of one System, field of the other, number of its entries) for all fields, in order."
    yield "template <class A, class B, class F> void visit_fields(A& a, const B& b, F&& f) {"
    for name, _, shape, _ in FIELDS:
        yield f"  f(a.{name}, b.{name}, {entries('b', shape)});"
    yield "}"


def entries(of: str, shape: tuple[str | int, ...]) -> str:
    """The number of entries of a field."""
    return "*".join(str(n) if isinstance(n, int) else f"{of}.{member(n)}" for n in shape)


def binding() -> Iterator[str]:
    """The function that binds a System to bytes."""
    yield "/// Set every pointer of a System; the number of bytes used, or -1 when they do not fit."
    yield "inline std::int64_t bind(System& s, const unsigned char* bytes, std::int64_t size) {"
    head = 16 + 8 * len(COUNTS)
    yield f'  if (size < {head} || std::memcmp(bytes, "CLUTCHWK", 8) != 0) return -1;'
    yield "  std::int64_t hash; std::memcpy(&hash, bytes + 8, 8);"
    yield "  if (hash != schema_hash) return -1;"
    for i, (name, _) in enumerate(COUNTS):
        yield f"  std::memcpy(&s.{member(name)}, bytes + {16 + 8 * i}, 8);"
        yield f"  if (s.{member(name)} < 0 || s.{member(name)} > (1 << 28)) return -1;"
    yield f"  std::int64_t at = {head};"
    for name, kind, shape, _ in FIELDS:
        size = entries("s", shape)
        yield f"  s.{name} = reinterpret_cast<const {TYPES[kind]}*>(bytes + at);"
        yield f"  at += ({size}) * {8 if kind == 'f8' else 4}; at = (at + 7) / 8 * 8;"
        yield "  if (at > size) return -1;"
    yield "  return at;"
    yield "}"


def rows() -> Iterator[str]:
    """Row blocks and event columns."""
    yield "/// Offsets of the blocks of one output row."
    yield "struct RowLayout {"
    yield "  " + " ".join(f"std::int64_t {name};" for name, _ in ROW) + " std::int64_t size;"
    yield "  explicit RowLayout(const SystemCounts& s) {"
    yield "    std::int64_t at = 0;"
    for name, count in ROW:
        yield f"    {name} = at; at += s.{member(count)};"
    yield "    size = at;"
    yield "  }"
    yield "};"
    yield f"inline constexpr int event_size = {len(EVENT)};"
