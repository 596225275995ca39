"""What a driveline gives as a function of JAX."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from importlib import import_module
from typing import Any

import numpy as np

from clutchwork.base import UseError, quote
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained
from clutchwork.frameworks.lines import no_second, refuse, values, values_and_matrix
from clutchwork.gradients.differentiable import Differentiable

CALL = "cw.to_jax"
BITS = 'jax.config.update("jax_enable_x64", True)'


@explained("to_jax", f="cw.differentiable(model, 2.0, of=..., by=...)")
def to_jax(f: Differentiable) -> Callable[[Any], Any]:
    """A function of JAX: values of a driveline at an array x of its numbers, with exact derivatives.

    Parameters: f, what `cw.differentiable` gives.

    Use it where a driveline is a part of a larger computation in JAX. It works under `jit`, `grad`, `value_and_grad`,
    `jacfwd`, `jacrev`, `jvp`, `vjp` and `vmap`, which runs on threads; runs stay on the CPU. x (..., by) is float64 in
    SI, in the order of `f.by`; the values (..., of) are in the order of `f.of`. ImportError without JAX; UseError for
    float32, another shape and second derivatives. A derivative that does not exist is NaN, where it is used;
    `NoGradient` where there is none at all, inside `jit` with its message in a JaxRuntimeError, and NaN for one line of
    many. `f.gradient(x).problems` says why. docs/guide/frameworks.md
    """
    jax = need("jax", "jax", CALL)
    if not isinstance(f, Differentiable):
        raise UseError(CALL, [f"f is {quote(f)}: give what cw.differentiable gives"])
    function = _differentiated(jax, f)

    def of_driveline(x: Any) -> Any:
        if not jax.config.jax_enable_x64:
            raise UseError(CALL, [f"JAX computes in float32, too coarse for the derivatives of a run; call {BITS}"])
        given = jax.numpy.asarray(x)
        refuse(CALL, f, given.shape, str(given.dtype), "give x.astype(float)")
        return function(given)

    return of_driveline


def _differentiated(jax: Any, f: Differentiable) -> Callable[[Any], Any]:
    """The function with its rule: tangents are linear in those of x, and JAX turns the rule round for reverse mode."""

    def primal(x: Any) -> Any:
        return _on_host(jax, partial(values, f), [(len(f.of),)], x)[0]

    def local(x: Any) -> Any:
        return _on_host(jax, partial(values_and_matrix, f), [(len(f.of),), (len(f.of), len(f.by))], x)

    def rule(primals: Any, tangents: Any) -> tuple[Any, Any]:
        found, matrix = derived(*primals)
        return found, product.bind(matrix, *tangents)

    def refused(_primals: Any, _tangents: Any) -> Any:
        raise no_second(CALL)

    product = _product()
    function, derived = jax.custom_jvp(primal), jax.custom_jvp(local)
    function.defjvp(rule)
    derived.defjvp(refused)
    return function  # type: ignore[no-any-return]


@cache
def _product() -> Any:
    """Matrix times vector, where anything times zero is zero: a derivative that is missing counts where it is used.

    JAX turns it round for reverse mode, in which the weights of values that a loss does not use are zero.
    """
    jax = need("jax", "jax", CALL)
    ad, batching, mlir = (import_module(f"jax.interpreters.{name}") for name in ("ad", "batching", "mlir"))
    made = import_module("jax.extend.core").Primitive("clutchwork_product")

    def product(matrix: Any, vector: Any) -> Any:
        beside = vector[..., None, :]
        return jax.numpy.where(beside == 0.0, 0.0, matrix * beside).sum(-1)

    def batched(given: Any, axes: Any) -> tuple[Any, int]:
        count = next(one.shape[axis] for one, axis in zip(given, axes, strict=True) if axis is not None)
        return made.bind(*(batching.bdim_at_front(one, axis, count) for one, axis in zip(given, axes, strict=True))), 0

    def turned(weights: Any, matrix: Any, _vector: Any) -> tuple[None, Any]:
        return None, made.bind(jax.numpy.swapaxes(matrix, -1, -2), ad.instantiate_zeros(weights))

    made.def_impl(product)
    made.def_abstract_eval(lambda matrix, _: jax.core.ShapedArray(matrix.shape[:-1], matrix.dtype))
    mlir.register_lowering(made, mlir.lower_fun(product, multiple_results=False))
    ad.defjvp(made, None, lambda change, matrix, _: made.bind(matrix, change))
    ad.primitive_transposes[made] = turned
    batching.primitive_batchers[made] = batched
    return made


def _on_host(jax: Any, work: Callable[[Any], Any], shapes: Sequence[tuple[int, ...]], x: Any) -> list[Any]:
    """Arrays of shapes for each line of x, computed by NumPy."""

    def arrays(x: Any) -> list[Any]:
        made = work(np.asarray(x))
        return list(made) if isinstance(made, tuple) else [made]

    # outside of jit and vmap, errors keep their class
    if not isinstance(x, jax.core.Tracer):
        return [jax.numpy.asarray(one) for one in arrays(x)]
    wanted = [jax.ShapeDtypeStruct((*x.shape[:-1], *shape), "float64") for shape in shapes]
    return list(jax.pure_callback(arrays, wanted, x, vmap_method="expand_dims"))
