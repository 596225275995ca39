"""What a driveline gives as a function of PyTorch."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from clutchwork.base import UseError, quote
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained
from clutchwork.frameworks.lines import no_second, refuse, values, values_and_matrix
from clutchwork.gradients.differentiable import Differentiable

CALL = "cw.to_torch"


@explained("to_torch", f="cw.differentiable(model, 2.0, of=..., by=...)")
def to_torch(f: Differentiable) -> Callable[[Any], Any]:
    """A function of PyTorch: values of a driveline at a tensor x of its numbers, with exact derivatives.

    Parameters: f, what `cw.differentiable` gives.

    Use it where a driveline is a part of a larger computation in PyTorch, such as a loss. It works with `backward`,
    `torch.func.grad`, `jacrev`, `jacfwd`, `jvp`, `vjp` and `vmap`, which runs on threads; runs stay on the CPU, values
    come back to the device of x. x (..., by) is float64 in SI, in the order of `f.by`; the values (..., of) are in the
    order of `f.of`. ImportError without PyTorch; UseError for float32, another shape and second derivatives;
    a derivative that does not exist is NaN, where it is used. `NoGradient` where there is none at all, and NaN for one
    line of many; `f.gradient(x).problems` says why. docs/guide/frameworks.md
    """
    torch = need("torch", "torch", CALL)
    if not isinstance(f, Differentiable):
        raise UseError(CALL, [f"f is {quote(f)}: give what cw.differentiable gives"])

    def of_driveline(x: Any) -> Any:
        given = torch.as_tensor(x)
        refuse(CALL, f, given.shape, str(given.dtype).removeprefix("torch."), "give x.double()")
        return _functions()[0].apply(f, given)

    return of_driveline


def _made(like: Any, array: Any) -> Any:
    """A tensor of an array, where another one is."""
    return like.new_tensor(array)


def _numbers(x: Any) -> Any:
    return x.detach().cpu().numpy()


def _first(x: Any, axis: int | None) -> Any:
    """Lines along the first axis, however `vmap` holds them."""
    return x if axis is None else x.movedim(axis, 0)


def _product(torch: Any, matrix: Any, vector: Any) -> Any:
    """Matrix times vector, where anything times zero is zero: a derivative that is missing counts where it is used."""
    beside = vector[..., None, :]
    return torch.where(beside == 0.0, beside, matrix * beside).sum(-1)


@cache
def _functions() -> tuple[Any, Any]:
    """The functions of values and of derivatives, once PyTorch is there."""
    torch = need("torch", "torch", CALL)

    base: Any = torch.autograd.Function

    class Matrix(base):  # type: ignore[misc]
        """Derivatives of values."""

        @staticmethod
        def forward(f: Differentiable, x: Any) -> Any:
            return _made(x, values_and_matrix(f, _numbers(x))[1])

        @staticmethod
        def setup_context(_ctx: Any, _inputs: Any, _output: Any) -> None:
            """Nothing to keep."""

        @staticmethod
        def vmap(_info: Any, axes: Any, f: Differentiable, x: Any) -> Any:
            return Matrix.apply(f, _first(x, axes[1])), 0

        @staticmethod
        def backward(_ctx: Any, _weights: Any) -> Any:
            raise no_second(CALL)

        @staticmethod
        def jvp(_ctx: Any, _f: Any, _change: Any) -> Any:
            raise no_second(CALL)

    class Values(base):  # type: ignore[misc]
        """Values, whose derivatives are looked up where they are asked for."""

        @staticmethod
        def forward(f: Differentiable, x: Any) -> Any:
            return _made(x, values(f, _numbers(x)))

        @staticmethod
        def setup_context(ctx: Any, inputs: Any, _output: Any) -> None:
            ctx.f, x = inputs
            ctx.save_for_backward(x)
            ctx.save_for_forward(x)

        @staticmethod
        def vmap(_info: Any, axes: Any, f: Differentiable, x: Any) -> Any:
            return Values.apply(f, _first(x, axes[1])), 0

        @staticmethod
        def backward(ctx: Any, weights: Any) -> Any:
            matrix = Matrix.apply(ctx.f, *ctx.saved_tensors)
            return None, _product(torch, matrix.transpose(-1, -2), weights)

        @staticmethod
        def jvp(ctx: Any, _f: Any, change: Any) -> Any:
            matrix = Matrix.apply(ctx.f, *ctx.saved_tensors)
            return _product(torch, matrix, change)

    return Values, Matrix
