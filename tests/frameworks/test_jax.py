"""A driveline as a function of JAX: each of its transformations gives what the driveline itself gives."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.pages import page
from support.two_discs_by_numbers import SLOW, two_discs

jax = pytest.importorskip("jax")

F = two_discs()
VALUES, MATRIX = F.value_and_jacobian(F.x0)
LINES = F.x0 * np.linspace(0.9, 1.1, 3)[:, None]
# round-off of runs that save other rows
CLOSE = {"rtol": 1e-9, "atol": 1e-12}


@pytest.fixture(autouse=True)
def doubles():
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


@pytest.fixture
def g():
    return cw.to_jax(F)


@pytest.mark.parametrize("compiled", [lambda one: one, jax.jit], ids=["as it is", "jit"])
class TestTransformations:
    def test_values(self, g, compiled):
        np.testing.assert_allclose(compiled(g)(F.x0), VALUES, **CLOSE)

    @pytest.mark.parametrize("mode", [jax.jacfwd, jax.jacrev])
    def test_jacobian(self, g, compiled, mode):
        np.testing.assert_allclose(compiled(mode(g))(F.x0), MATRIX, **CLOSE)

    @pytest.mark.parametrize("mode", [jax.jacfwd, jax.jacrev])
    def test_lines(self, g, compiled, mode):
        values, matrices = F.batch_jacobian(LINES)
        np.testing.assert_allclose(compiled(jax.vmap(g))(LINES), values, **CLOSE)
        np.testing.assert_allclose(compiled(jax.vmap(mode(g)))(LINES), matrices, **CLOSE)
        np.testing.assert_allclose(compiled(jax.vmap(jax.vmap(g)))(LINES[:, None]), values[:, None], **CLOSE)
        np.testing.assert_allclose(compiled(g)(LINES), values, **CLOSE)

    def test_loss(self, g, compiled):
        """By hand: the derivatives of a sum of squares are 2 of values times their derivatives."""
        value, gradient = compiled(jax.value_and_grad(lambda x: (g(3.0 * x / 3.0) ** 2).sum()))(F.x0)
        np.testing.assert_allclose(value, VALUES @ VALUES, **CLOSE)
        # the smaller one is what large parts leave of each other
        wanted = 2.0 * VALUES @ MATRIX
        np.testing.assert_allclose(gradient, wanted, rtol=1e-9, atol=1e-11 * np.abs(wanted).max())

    def test_one_value(self, compiled):
        """Goes by `f.vjp`."""
        one = cw.to_jax(cw.differentiable(F.system, 2.5, of="c1.heat", by=F.by))
        gradient = compiled(jax.grad(lambda x: one(x)[0]))(F.x0)
        np.testing.assert_allclose(gradient, MATRIX[2], rtol=1e-9, atol=1e-6)


def one_output(name):
    return cw.to_jax(cw.differentiable(F.system, 2.5, of=F.task.outputs[name], by=F.by))


def test_one_run_gives_values_and_derivatives(g, monkeypatch):
    runs = []
    gradient = type(F.engine).gradient
    monkeypatch.setattr(type(F.engine), "gradient", lambda self, x: runs.append(x) or gradient(self, x))
    jax.jit(jax.jacrev(g))(F.x0 * 1.01)
    assert len(runs) == 1


def test_what_has_no_gradient(g):
    why, locks = r"lock\(c1\) does not happen before 2.5 s", one_output("lock(c1)")
    with pytest.raises(cw.NoGradient, match=why):
        jax.jacrev(locks)(SLOW)
    with pytest.raises(RuntimeError, match=why):
        jax.jit(jax.jacfwd(locks))(SLOW)


@pytest.mark.parametrize("mode", [jax.jacfwd, jax.jacrev])
def test_a_value_without_a_derivative_takes_no_other_with_it(g, mode):
    lines, lost = np.array([SLOW, F.x0]), np.array([F.of[number] == "lock(c1)" for number in range(len(F.of))])
    for found in (mode(g)(SLOW), jax.jit(mode(g))(SLOW), jax.vmap(mode(g))(lines)[0]):
        np.testing.assert_array_equal(np.isnan(found).all(axis=1), lost)
        np.testing.assert_allclose(found[~lost], F.jacobian(SLOW)[~lost], **CLOSE)
    np.testing.assert_allclose(jax.vmap(mode(g))(lines)[1], MATRIX, **CLOSE)
    # a loss that uses others has its gradient, under vmap too
    others = jax.grad(lambda x: g(x)[~lost].sum())
    np.testing.assert_allclose(others(SLOW), F.jacobian(SLOW)[~lost].sum(axis=0), **CLOSE)
    np.testing.assert_allclose(jax.vmap(others)(lines)[0], others(SLOW), **CLOSE)


def test_what_is_refused(g):
    with pytest.raises(cw.UseError, match=r"x is float32.*x\.astype\(float\)"):
        g(np.ones(2, np.float32))
    with pytest.raises(cw.UseError, match=r"shape \(3,\); give 2 numbers .* engine.inertia, c1.gain"):
        g(np.ones(3))
    with pytest.raises(cw.UseError, match="first derivatives only"):
        jax.hessian(lambda x: g(x)[0])(F.x0)
    with pytest.raises(cw.UseError, match=r"give what cw\.differentiable gives"):
        cw.to_jax(np.sin)
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(cw.UseError, match=r'jax\.config\.update\("jax_enable_x64", True\)'):
        g(F.x0)


def test_the_page(run_of_page):
    found = run_of_page(page("guide/frameworks.md"), "JAX")
    np.testing.assert_allclose(found["jacobian"], MATRIX, **CLOSE)
    assert found["jacobians"].shape == (5, 3, 2)
