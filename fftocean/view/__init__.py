"""Live page: server, static page, notebook widget."""
