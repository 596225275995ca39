"""Small FMUs in C, compiled here, that behave and that do not: what people write by hand."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from zipfile import ZipFile

from clutchwork.fmu_import.fmu import places

COMPILER = shutil.which("cc")

# an integrator dx/dt = u + bias with output y = x; `mode` says how it misbehaves, `when` from which step on
TWO = r"""
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void (*Log)(void *, const char *, int, const char *, const char *, ...);
typedef struct { Log log; void *(*calloc)(size_t, size_t); void (*free)(void *); void *finished; void *env; } Callbacks;
typedef struct { const Callbacks *calls; double x, u, bias, bar, text[16]; int mode, when, steps, flag; } Model;

#ifdef HANG_WHEN_LOADED
__attribute__((constructor)) static void stay(void) { for (;;) pause(); }
#endif

static void say(Model *m, const char *text) { m->calls->log(m->calls->env, "m", 3, "error", "%s", text); }

static int misbehave(Model *m, int place) {
    if (m->mode / 100 != place || m->steps < m->when) return 0;
    switch (m->mode % 100) {
        case 1: *(volatile int *)0 = 1; break;
        case 2: exit(0);
        case 3: for (;;) pause();
        case 4: say(m, "the valve is stuck"); return 3;
        case 5: return 2;
        case 6: return 4;
        case 7: m->x = NAN; break;
        case 8: m->x = INFINITY; break;
        case 9: abort();
        case 10: for (int n = 3; n < 64; ++n) close(n); break;
        case 11: return 5;
        case 12: raise(SIGSTOP); break;
        case 13: _exit(7);
        case 14: {
            char line[4096];
            memset(line, 'x', sizeof line);
            for (int n = 0; n < 300; ++n) fwrite(line, 1, sizeof line, stdout), fwrite(line, 1, sizeof line, stderr);
            fflush(stdout);
            break;
        }
        case 15: { char one; m->x += read(0, &one, 1); break; }
    }
    return 0;
}

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *where, const Callbacks *calls,
    int seen, int log) {
    (void)name, (void)kind, (void)where, (void)seen, (void)log;
    if (strcmp(guid, "{right}") != 0) return NULL;
    Model *m = calls->calloc(1, sizeof *m);
    m->calls = calls;
    printf("hello from an FMU\n");
    return m;
}
int fmi2SetupExperiment(Model *m, int tolerant, double tolerance, double start, int ends, double stop) {
    (void)m, (void)tolerant, (void)tolerance, (void)start, (void)ends, (void)stop;
    return 0;
}
int fmi2EnterInitializationMode(Model *m) { return misbehave(m, 1); }
int fmi2ExitInitializationMode(Model *m) { return misbehave(m, 2); }
int fmi2DoStep(Model *m, double t, double h, int none) {
    (void)t, (void)none;
    m->steps++;
    m->x += h * (m->u + m->bias);
    return misbehave(m, 3);
}
int fmi2GetBooleanStatus(Model *m, int kind, int *value) { *value = kind == 2 && m->bias == 3.0; return 0; }
int fmi2SetReal(Model *m, const unsigned *r, size_t n, const double *v) {
    for (size_t k = 0; k < n; ++k) {
        if (r[k] == 1) m->u = v[k];
        if (r[k] == 2) m->bias = v[k];
        if (r[k] == 5) m->bar = v[k];
    }
    return 0;
}
#ifndef NO_GET
int fmi2GetReal(Model *m, const unsigned *r, size_t n, double *v) {
    for (size_t k = 0; k < n; ++k) v[k] = r[k] == 1 ? m->u : r[k] == 6 ? 2.0 * m->bar : m->x;
    return 0;
}
#endif
int fmi2SetInteger(Model *m, const unsigned *r, size_t n, const int *v) {
    for (size_t k = 0; k < n; ++k) *(r[k] == 3 ? &m->mode : &m->when) = v[k];
    return 0;
}
int fmi2GetInteger(Model *m, const unsigned *r, size_t n, int *v) {
    for (size_t k = 0; k < n; ++k) v[k] = r[k] == 7 ? m->steps : m->mode;
    return 0;
}
int fmi2SetBoolean(Model *m, const unsigned *r, size_t n, const int *v) { (void)r, (void)n; m->flag = v[0]; return 0; }
int fmi2GetBoolean(Model *m, const unsigned *r, size_t n, int *v) { (void)r, (void)n; v[0] = m->flag; return 0; }
int fmi2Terminate(Model *m) { return misbehave(m, 4); }
void fmi2FreeInstance(Model *m) { m->calls->free(m); }
"""

DESCRIPTION_TWO = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="small" guid="{guid}">
  <CoSimulation modelIdentifier="small" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions><Unit name="decibar"><BaseUnit kg="1" m="-1" s="-2" factor="1e4"/></Unit></UnitDefinitions>
  <ModelVariables>
    <ScalarVariable name="y" valueReference="0" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="u" valueReference="1" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="bias" valueReference="2" causality="parameter"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="mode" valueReference="3" causality="parameter"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="when" valueReference="4" causality="parameter"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="p" valueReference="5" causality="input"><Real start="0" unit="decibar"/></ScalarVariable>
    <ScalarVariable name="q" valueReference="6" causality="output"><Real unit="bar"/></ScalarVariable>
    <ScalarVariable name="steps" valueReference="7" causality="output"><Integer/></ScalarVariable>
    <ScalarVariable name="on" valueReference="8" causality="input"><Boolean start="false"/></ScalarVariable>
    <ScalarVariable name="is on" valueReference="8" causality="output"><Boolean/></ScalarVariable>
    <ScalarVariable name="title" valueReference="9" causality="output"><String/></ScalarVariable>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>
"""

# the same for FMI 3.0, as far as it is called
THREE = r"""
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef void (*Log)(void *, int, const char *, const char *);
typedef struct { Log log; double x, u; int32_t mode; bool on; } Model;

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *where, bool seen, bool logging,
    bool events, bool early, const unsigned *required, size_t n, void *env, Log log, void *update) {
    (void)name, (void)seen, (void)logging, (void)required, (void)n, (void)env, (void)update;
    size_t end = strlen(where);
    if (strcmp(token, "{right}") != 0 || events || early || where[end - 1] != '/') return NULL;
    Model *m = calloc(1, sizeof *m);
    m->log = log;
    return m;
}
int fmi3EnterInitializationMode(Model *m, bool d, double t, double start, bool ends, double stop) {
    (void)m, (void)d, (void)t, (void)start, (void)ends, (void)stop;
    return 0;
}
int fmi3ExitInitializationMode(Model *m) { (void)m; return 0; }
int fmi3DoStep(Model *m, double t, double h, bool none, bool *event, bool *terminate, bool *early, double *last) {
    (void)none;
    *event = false, *terminate = m->mode == 2, *early = m->mode == 3, *last = t + h;
    if (m->mode == 1) { m->log(NULL, 3, "error", "the valve is stuck"); return 3; }
    if (m->mode == 4) abort();
    m->x += h * m->u;
    return 0;
}
int fmi3SetFloat64(Model *m, const unsigned *r, size_t n, const double *v, size_t nv) {
    (void)r, (void)n; if (nv != 1) return 3; m->u = v[0]; return 0;
}
int fmi3GetFloat64(Model *m, const unsigned *r, size_t n, double *v, size_t nv) {
    (void)r, (void)n; if (nv != 1) return 3; v[0] = m->x; return 0;
}
int fmi3SetInt32(Model *m, const unsigned *r, size_t n, const int32_t *v, size_t nv) {
    (void)r, (void)n, (void)nv; m->mode = v[0]; return 0;
}
int fmi3SetBoolean(Model *m, const unsigned *r, size_t n, const bool *v, size_t nv) {
    (void)r, (void)n, (void)nv; m->on = v[0]; return 0;
}
int fmi3GetBoolean(Model *m, const unsigned *r, size_t n, bool *v, size_t nv) {
    (void)r, (void)n, (void)nv; v[0] = m->on; return 0;
}
int fmi3Terminate(Model *m) { (void)m; return 0; }
void fmi3FreeInstance(Model *m) { free(m); }
"""

DESCRIPTION_THREE = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="small" instantiationToken="{guid}">
  <CoSimulation modelIdentifier="small" canHandleVariableCommunicationStepSize="true"/>
  <ModelVariables>
    <Float64 name="time" valueReference="9" causality="independent" variability="continuous"/>
    <Float64 name="y" valueReference="0" causality="output"/>
    <Float64 name="u" valueReference="1" causality="input" start="0"/>
    <Int32 name="mode" valueReference="3" causality="parameter" variability="fixed" start="0"/>
    <Boolean name="on" valueReference="8" causality="input" start="false"/>
    <Boolean name="is on" valueReference="8" causality="output"/>
    <Float64 name="many" valueReference="10" causality="output"><Dimension start="3"/></Float64>
    <Clock name="tick" valueReference="11" causality="output" intervalVariability="triggered"/>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>
"""

SOURCES = {"2.0": (TWO, DESCRIPTION_TWO), "3.0": (THREE, DESCRIPTION_THREE)}


@cache
def library(version: str, defines: tuple[str, ...] = ()) -> bytes:
    """A library as bytes."""
    folder = Path(mkdtemp())
    source, made = folder / "small.c", folder / "small.so"
    source.write_text(SOURCES[version][0])
    flags = [f"-D{name}" for name in defines]
    subprocess.run([COMPILER, "-shared", "-fPIC", "-O1", *flags, "-o", made, source], check=True)
    content = made.read_bytes()
    shutil.rmtree(folder)
    return content


def small(
    path: Path,
    version: str = "2.0",
    *,
    guid: str = "{right}",
    defines: Sequence[str] = (),
    more: Mapping[str, bytes] | None = None,
) -> Path:
    """Write a small FMU; its path."""
    text = SOURCES[version][1].replace("{guid}", guid).encode()
    with ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        archive.writestr(places(version, "small")[0], library(version, tuple(defines)))
        for name, content in (more or {}).items():
            archive.writestr(name, content)
    return path
