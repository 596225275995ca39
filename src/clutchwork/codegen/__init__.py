"""C and C++ of a model: a folder that builds and runs without Python."""

from clutchwork.codegen.folder import export_c as export_c
