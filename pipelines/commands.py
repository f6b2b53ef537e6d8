"""The pipelines that are sub-commands of scratchwarp."""

from . import author, bake, compare, contact_sheet, export, farm_model, publish, topography, turntable, validate, zoom
from .command import Command

PIPELINES = (author, bake, compare, contact_sheet, export, farm_model, publish, topography, turntable, validate, zoom)
COMMANDS: dict[str, Command] = {module.COMMAND.name: module.COMMAND for module in PIPELINES}
