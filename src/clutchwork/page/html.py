"""One file of HTML: style, script, core and data, and a policy that lets nothing else run or be fetched."""

from __future__ import annotations

import gzip
import json
from base64 import b64encode
from hashlib import sha256
from typing import Any

from clutchwork.base.html import text
from clutchwork.page.static import CORE, SCRIPT, STYLE, built

LONGEST = 600_000  # bytes of a page


def html(data: dict[str, Any], title: str, script: str = SCRIPT, core: bool = True) -> str:
    """The whole page.

    Parameters: script, the file of it; core, whether it computes.
    """
    style, code = built(STYLE).decode(), built(script).decode()
    # what would end the element early is written otherwise in a string
    code = code.replace("</script", "<\\/script").replace("<!--", "<\\!--")
    engine = f'<script type="text/plain" id="core">{packed(built(CORE))}</script>\n' if core else ""
    policy = "; ".join(
        (
            "default-src 'none'",
            f"script-src '{_hash(code)}' 'wasm-unsafe-eval'",
            f"style-src '{_hash(style)}'",
            "img-src data: blob:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="clutchwork">
<title>{text(title)}</title>
<style>{style}</style>
</head>
<body>
<main id="page"><h1>{text(title)}</h1><p role="status">Loading. This page needs JavaScript and WebAssembly.</p></main>
<script type="text/plain" id="data">{packed(as_json(data))}</script>
{engine}<script>{code}</script>
</body>
</html>
"""


def as_json(data: dict[str, Any]) -> bytes:
    """Data as JSON without spaces; numbers as they are, bit for bit."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False, ensure_ascii=False, default=list).encode()


def packed(content: bytes) -> str:
    """Content as gzip in letters, the same for the same content."""
    return b64encode(gzip.compress(content, 9, mtime=0)).decode()


def _hash(content: str) -> str:
    return f"sha256-{b64encode(sha256(content.encode()).digest()).decode()}"
