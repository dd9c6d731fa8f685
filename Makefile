# Every target sets up what it needs: a virtual environment from constraints.txt, system packages where it may.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready

.PHONY: demo test lint bench setup schemas constraints clean

demo: $(READY)
	$(BIN)/raycheck demo --out raycheck-demo

test: $(READY) lint
	$(BIN)/python -P -m pytest -n auto

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(READY)
	$(BIN)/python -P benchmarks/render_speed.py
	$(BIN)/python -P benchmarks/bit_for_bit.py
	$(BIN)/python -P benchmarks/suite_overhead.py
	$(BIN)/python -P benchmarks/sensitivity.py
	$(BIN)/python -P benchmarks/containment.py
	$(BIN)/python -P benchmarks/dialects.py
	$(BIN)/python -P benchmarks/false_alarms.py
	$(BIN)/python -P benchmarks/laws_speed.py
	$(BIN)/python -P benchmarks/laws_table.py
	$(BIN)/python -P benchmarks/peers.py
	$(BIN)/python -P benchmarks/diagnosis.py
	$(BIN)/python -P benchmarks/private_faults.py
	$(BIN)/python -P benchmarks/located.py
	$(BIN)/python -P benchmarks/gates.py
	$(BIN)/python -P benchmarks/shrinking.py
	$(BIN)/python -P benchmarks/stochastic_gate.py
	$(BIN)/python -P benchmarks/grading.py

setup: $(READY)

$(READY): constraints.txt pyproject.toml tools/system-packages
	sh tools/system-packages
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -r tools/build-requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt \
	  --no-build-isolation -e ".[cluster,peers,dev]"
	touch $@

# Pins anew: needs uv. Writes name==version lines only.
constraints:
	uv pip compile --quiet --universal --python-version 3.11 --no-header --no-annotate --no-emit-index-url \
	  --no-emit-find-links --extra cluster --extra peers --extra dev --extra cluster pyproject.toml tools/build-requirements.txt -o constraints.txt

# The published schemas, from the models.
schemas: $(READY)
	$(BIN)/python -P -c "from pathlib import Path; from scenes import json_form; from reports import chart, power, results, stability; \
	  Path('scenes/schema/scene-1.json').write_text(json_form.schema()); \
	  Path('reports/schema/results-1.json').write_text(results.schema()); \
	  Path('reports/schema/stability-1.json').write_text(stability.schema()); \
	  Path('reports/schema/chart-1.json').write_text(chart.schema()); \
	  Path('reports/schema/power-1.json').write_text(power.schema())"

clean:
	rm -rf $(VENV) raycheck-demo raycheck-report raycheck-stability raycheck-chart raycheck-peers raycheck-power raycheck-faults examples/*/tracer
