"""Two new files make an element, two make a friction law; nothing else is edited."""

from __future__ import annotations

from pathlib import Path

import pytest

from support import project

ELEMENT = '''"""Damper whose torque grows with the cube of the rate."""

from __future__ import annotations

from clutchwork.declare.node import Component, Node
from clutchwork.declare.schema import Role, component, param, port


@component(Role.TORQUE)
class CubicDamper(Component):
    """Torque on the follower: -(linear rate + cubic rate^3). Use it to see how an element is added."""

    base: Node = port("side that the rate is measured from")
    follower: Node = port("side whose motion is positive")
    linear: float = param("N m s/rad", "viscous part", at_least=0.0)
    cubic: float = param("N m s3/rad3", "cubic part", at_least=0.0)
'''

ELEMENT_HEADER = """#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Damper whose torque grows with the cube of the rate.
struct CubicDamper : declared::CubicDamper {
  template <class T>
  struct Params {
    T linear;  ///< [N m s/rad]
    T cubic;   ///< [N m s3/rad3]
  };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -(p.linear * at.rate + p.cubic * at.rate * at.rate * at.rate);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}
};

}  // namespace clutchwork::elements
"""

LAW = '''"""Kinetic coefficient that falls hyperbolically."""

from __future__ import annotations

from clutchwork.declare.node import Law
from clutchwork.declare.schema import Role, component, param


@component(Role.LAW)
class Hyperbolic(Law):
    """Kinetic coefficient `slow/(1 + abs(slip)/speed)`. Use it to see how a law is added."""

    static: float = param("1", "coefficient at rest", above=0.0)
    slow: float = param("1", "kinetic coefficient at vanishing slip", at_least=0.0)
    speed: float = param("rad/s", "slip at which half is left", above=0.0)
'''

LAW_HEADER = """#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::laws {

/// Kinetic coefficient that falls hyperbolically.
struct Hyperbolic : declared::Hyperbolic {
  template <class T>
  struct Params {
    T static_;  ///< [1]
    T slow;     ///< [1]
    T speed;    ///< [rad/s]
  };

  template <class T, class S>
  static S slide(const Params<T>& p, const At<S>& at) {
    return S(p.slow) / (S(1.0) + at.rate / S(p.speed));
  }
  template <class T>
  static T hold(const Params<T>& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork::laws
"""

# closed forms: dw/dt = -(d w + c w^3)/J; (s + s^2/(2 v)) T/J falls linearly in time, so lock at J (s0 + s0^2/(2 v))/T
USE = """
import math
import clutchwork as cw

d = cw.Driveline("new element")
a = d.shaft("a", inertia=0.5, speed=8.0)
d.add(cw.CubicDamper("damper", base=d.housing, follower=a, linear=0.4, cubic=0.02))
run = d.simulate(1.0, rtol=1e-11, atol=1e-12)
e = math.exp(-2 * 0.4 / 0.5)
expected = 8.0 * math.sqrt(e / (1 + 0.02 / 0.4 * 64.0 * (1 - e)))
assert abs(run["a.speed"][-1] - expected) < 1e-8, (run["a.speed"][-1], expected)

d = cw.Driveline("new law")
a = d.shaft("a", inertia=0.5, speed=60.0)
law = cw.Hyperbolic(static=0.3, slow=0.2, speed=25.0)
d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=100.0))
run = d.simulate(6.0, rtol=1e-11, atol=1e-12)
lock = [e.time for e in run.events if e.after == "locked"]
assert len(lock) == 1 and abs(lock[0] - 0.5 * (60 + 3600 / 50) / 20) < 1e-9, lock

# the model file knows them too
d.save(FILE)
again = cw.Driveline.load(FILE).simulate(6.0, rtol=1e-11, atol=1e-12)
assert [e.time for e in again.events if e.after == "locked"] == lock

# and bad values are refused with the bounds of the declaration
try:
    bad = cw.Driveline("bad")
    bad.add(cw.CubicDamper("damper", base=bad.housing, follower=bad.shaft("a", inertia=1.0), linear=-1.0, cubic=0.0))
    bad.assemble()
except Exception as error:
    assert "linear" in str(error), error
else:
    raise AssertionError("a negative damping went through")
print("used")
"""


@pytest.mark.slow
def test_two_files_make_an_element_and_two_a_law(tmp_path: Path) -> None:
    copy = project.copy(tmp_path / "project")
    new = {
        "src/clutchwork/elements/cubic_damper.py": ELEMENT,
        "cpp/include/clutchwork/elements/cubic_damper.hpp": ELEMENT_HEADER,
        "src/clutchwork/laws/hyperbolic.py": LAW,
        "cpp/include/clutchwork/laws/hyperbolic.hpp": LAW_HEADER,
    }
    for name, text in new.items():
        assert not (copy / name).exists()
        (copy / name).write_text(text)
    site = tmp_path / "site"
    built = project.install(copy, site)
    assert built.returncode == 0, built.stdout + built.stderr
    # type checkers and editors know them
    stub = (site / "clutchwork/__init__.pyi").read_text()
    assert "class CubicDamper(Element):" in stub
    assert "class Hyperbolic(Law):" in stub
    used = project.run_in(site, f"FILE = {str(tmp_path / 'model.toml')!r}\n{USE}")
    assert used.stdout.strip() == "used", used.stderr
