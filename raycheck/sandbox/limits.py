"""What a program in the sandbox may use."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

MIB = 2**20
Amount = Annotated[int, Field(gt=0, le=2**20, strict=True)]
Duration = Annotated[float, Field(gt=0, le=3600)]


class Limits(BaseModel):
    """Limits of one run, in MiB, processes and seconds; all of a program's processes together but for `cpu`.

    memory: kept in memory, its temporary files included where the system counts them; processes: with
    their threads; temporary: files in /tmp and /dev/shm, each; disk: files in its own folder; cpu: processor
    time of any one process; build, render: wall time (a manifest may ask for less to render); probe: wall time of
    all answers of a probe together.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    memory: Amount = 2048
    processes: Amount = 512
    temporary: Amount = 512
    disk: Amount = 512
    cpu: Amount = 600
    build: Duration = 120.0
    render: Duration = 30.0
    probe: Duration = 120.0
