"""Reports, plans and data sheets of what ``photile measure`` and ``photile daylight`` have found.

They are drawn from the JSON that ``-o results.json`` writes, by the templates beside this file::

    python3 -m photile.report results.json -o report.html -o report.pdf -o plan.svg --template letterhead

Debian's packages python3-jinja2 and python3-contourpy draw pages and plans, weasyprint prints them as
PDF, python3-ezdxf writes DXF. The compiled module of ``import photile`` is not needed: ``photile measure -o
report.html`` starts this folder directly.
"""
