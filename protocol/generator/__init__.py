"""Turns the JSON Schemas of protocol/messages into C++, TypeScript and OpenAPI. See ../generate.py."""
