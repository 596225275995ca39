"""A driveline as a function of PyTorch: its checker of gradients, and each transformation against the driveline."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.pages import page
from support.two_discs_by_numbers import SLOW, two_discs

torch = pytest.importorskip("torch")
# PyTorch warns of its own functions
pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning:torch", "ignore:.torch.jit.script")

F = two_discs()
VALUES, MATRIX = F.value_and_jacobian(F.x0)
LINES = F.x0 * np.linspace(0.9, 1.1, 3)[:, None]
# round-off of runs that save other rows
CLOSE = {"rtol": 1e-9, "atol": 1e-12}


@pytest.fixture
def h():
    return cw.to_torch(F)


def test_the_checker_of_gradients(h):
    """Differences by PyTorch, forward and reverse, of values and numbers in parts of their own."""
    start, size = torch.tensor(F.x0), torch.tensor(VALUES)
    relative = torch.ones(2, dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(
        lambda x: h(x * start) / size, (relative,), eps=1e-4, atol=1e-6, rtol=1e-6, check_forward_ad=True
    )


def test_backward(h):
    x = torch.tensor(F.x0, requires_grad=True)
    values = h(x)
    np.testing.assert_allclose(values.detach(), VALUES, **CLOSE)
    (values**2).sum().backward()
    np.testing.assert_allclose(x.grad, 2.0 * VALUES @ MATRIX, **CLOSE)


@pytest.mark.parametrize("mode", ["jacrev", "jacfwd"])
def test_transformations(h, mode):
    jacobian = getattr(torch.func, mode)(h)
    np.testing.assert_allclose(jacobian(torch.tensor(F.x0)), MATRIX, **CLOSE)
    values, matrices = F.batch_jacobian(LINES)
    lines = torch.tensor(LINES)
    np.testing.assert_allclose(torch.func.vmap(h)(lines), values, **CLOSE)
    np.testing.assert_allclose(torch.func.vmap(h, in_dims=1)(lines.T), values, **CLOSE)
    np.testing.assert_allclose(torch.func.vmap(jacobian)(lines), matrices, **CLOSE)
    np.testing.assert_allclose(h(lines), values, **CLOSE)


def test_weights_at_once(h):
    """Another way of PyTorch to many backward passes."""
    x = torch.tensor(F.x0, requires_grad=True)
    (matrix,) = torch.autograd.grad(h(x), x, torch.eye(3, dtype=torch.float64), is_grads_batched=True)
    np.testing.assert_allclose(matrix, MATRIX, **CLOSE)


def test_lines_by_backward(h):
    lines = torch.tensor(LINES, requires_grad=True)
    h(lines)[:, 2].sum().backward()
    np.testing.assert_allclose(lines.grad, F.batch_jacobian(LINES)[1][:, 2], **CLOSE)


def test_one_value():
    """Goes by `f.vjp`."""
    one = cw.to_torch(cw.differentiable(F.system, 2.5, of="c1.heat", by=F.by))
    gradient = torch.func.grad(lambda x: one(x)[0])(torch.tensor(F.x0))
    np.testing.assert_allclose(gradient, MATRIX[2], rtol=1e-9, atol=1e-6)


def test_what_has_no_gradient(h):
    locks = cw.to_torch(cw.differentiable(F.system, 2.5, of=F.task.outputs["lock(c1)"], by=F.by))
    with pytest.raises(cw.NoGradient, match=r"lock\(c1\) does not happen before 2.5 s"):
        locks(torch.tensor(SLOW, requires_grad=True)).sum().backward()
    lost = np.array([name == "lock(c1)" for name in F.of])
    # others keep theirs
    x = torch.tensor(SLOW, requires_grad=True)
    h(x)[torch.tensor(~lost)].sum().backward()
    np.testing.assert_allclose(x.grad, F.jacobian(SLOW)[~lost].sum(axis=0), **CLOSE)
    many = torch.func.vmap(torch.func.jacrev(h))(torch.tensor(np.array([SLOW, F.x0])))
    np.testing.assert_array_equal(np.isnan(many.numpy()).any(axis=2), [lost, np.zeros_like(lost)])


def test_what_is_refused(h):
    with pytest.raises(cw.UseError, match=r"x is float32.*x\.double\(\)"):
        h(torch.ones(2))
    with pytest.raises(cw.UseError, match=r"shape \(3,\); give 2 numbers"):
        h(torch.ones(3, dtype=torch.float64))
    with pytest.raises(cw.UseError, match="first derivatives only"):
        torch.func.hessian(lambda x: h(x)[0])(torch.tensor(F.x0))
    with pytest.raises(cw.UseError, match=r"give what cw\.differentiable gives"):
        cw.to_torch(np.sin)


def test_the_page(run_of_page):
    found = run_of_page(page("guide/frameworks.md"), "PyTorch")
    np.testing.assert_allclose(found["jacobian"], MATRIX, **CLOSE)
    assert found["jacobians"].shape == (5, 3, 2)
