"""Pictures of runs; matplotlib and plotly are imported when the first one is drawn."""
