#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/interpolation.hpp>

/// What the header of an element or of a friction law includes: docs/extend.md.
