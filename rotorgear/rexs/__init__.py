"""Gearboxes in REXS (Reusable Engineering EXchange Standard, rexs.info) read into model files."""
